// Reads {body, memory, grid, kind, dt, wait, limit, after} from standard input, does a task with one mouse, which then rests over
// the tissue for a while, and writes how it went.
"use strict";
const [Wave, Hands] = process.argv.slice(2).map((path) => require(path));
const { body, memory, grid, kind, dt, wait, limit = 60, after = 0 } = JSON.parse(require("fs").readFileSync(0, "utf8"));
const tissue = new Wave.InteractiveTissue(new Wave.RadialBody(body), Wave.grid(...grid), Hands.MOST, memory);
const bench = new Hands.Bench({ wave: tissue }, "wave");
bench.task = new Hands.Task(kind, grid[0], tissue.body.deepest);
let k = -1, aim = -1, air = 0, refused = 0;
while (!bench.task.done && bench.time < limit) {
  const [target] = bench.task.current;
  if (k >= 0 && target.number !== aim) { bench.lift(k); k = -1; air = 0; }
  if (k < 0 && (air += dt) >= wait) {
    k = bench.free(target.x, target.y);
    if (k < 0) refused++; else bench.put(k, target.x, target.y, target.depth);
    aim = target.number;
  }
  bench.step(dt, "depth", 5e-3);
}
const { done, start, end } = bench.task, again = bench.history(0, 60).rested;
if (after) { bench.lift(k); bench.hover = [0.045, 0.045]; }
for (const last = bench.time; bench.time < last + after;) bench.step(dt, "depth", 5e-3);
process.stdout.write(JSON.stringify({ done, seconds: end - start, refused, csv: bench.csv(), again }));
