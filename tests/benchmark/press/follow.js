// Reads {bodies, runs} from standard input, carries each run out frame by frame, and writes forces and faces.
"use strict";
const Wave = require(process.argv[2]);
const { bodies, runs } = JSON.parse(require("fs").readFileSync(0, "utf8"));
const made = Object.fromEntries(Object.entries(bodies).map(([name, table]) => [name, table.side_m ? new Wave.PublishedBody(table) : new Wave.RadialBody(table)]));
const answers = runs.map((run) => {
  const tissue = new Wave.InteractiveTissue(made[run.body], Wave.grid(...run.grid), 4, run.memory);
  return run.frames.map(({ dt, touch = [], release = [] }, k) => {
    const refused = touch.map(([k, x, y, depth]) => tissue.touch(k, x, y, depth));
    for (const [k, steps] of release) tissue.release(k, steps);
    const faces = tissue.frame(dt), shown = k % 5 === 4 || k > 54;  // JSON of every frame takes longer than the frames
    return { refused, force: Array.from(tissue.force), faces: shown ? Array.from(faces) : null };
  });
});
process.stdout.write(JSON.stringify(answers));
