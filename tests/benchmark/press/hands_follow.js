// Reads {body, memory, grid, kind, dt, wait} from standard input, does a task with one mouse, and writes how it went.
"use strict";
const [Wave, Hands] = process.argv.slice(2).map((path) => require(path));
const { body, memory, grid, kind, dt, wait } = JSON.parse(require("fs").readFileSync(0, "utf8"));
const tissue = new Wave.InteractiveTissue(new Wave.RadialBody(body), Wave.grid(...grid), Hands.MOST, memory);
const bench = new Hands.Bench({ wave: tissue }, "wave");
bench.task = new Hands.Task(kind, grid[0], tissue.body.deepest);
let k = -1, aim = -1, air = 0, refused = 0;
while (!bench.task.done && bench.time < 60) {
  const [target] = bench.task.current;
  if (k >= 0 && target.number !== aim) { bench.lift(k); k = -1; air = 0; }
  if (k < 0 && (air += dt) >= wait) {
    k = bench.free(target.x, target.y);
    if (k < 0) refused++; else bench.put(k, target.x, target.y, target.depth);
    aim = target.number;
  }
  bench.step(dt, "depth", 5e-3);
}
const { done, start, end } = bench.task;
process.stdout.write(JSON.stringify({ done, seconds: end - start, refused, csv: bench.csv(), again: bench.history(0, 60).rested }));
