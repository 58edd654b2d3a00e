"use strict";
// Hands on several tissues at once (the wave, the wave with an effect, finite elements, the published membrane): where
// each tool is wanted, how fast it gets there, and the record of it. No drawing, no events.
const Hands = (() => {
  const MOST = 4, KEPT = 60, LET_GO = 12;

  class Bench {
    // `tissues` by name; `lead` is the name of the one whose answer is shown.
    constructor(tissues, lead) {
      this.tissues = tissues; this.lead = lead; this.time = 0;
      this.hands = Array.from({ length: MOST }, () => ({ on: false, x: 0, y: 0, goal: 0, at: 0, stay: false }));
      this.record = []; this.refused = "";
    }

    get shown() { return this.tissues[this.lead]; }
    get busy() { return this.shown.tools.filter((tool) => tool.phase !== "idle").length; }

    // A hand that is free, or -1.
    free() { return this.hands.findIndex((hand, k) => !hand.on && this.shown.tools[k].phase !== "returning"); }

    put(k, x, y, goal) {
      const hand = this.hands[k];
      if (!hand.on) Object.assign(hand, { on: true, at: 0 });
      Object.assign(hand, { x, y, goal });
    }

    lift(k) { this.hands[k].on = false; }

    // One frame of dt seconds: drive is "depth" or "force", pace how much of the goal's unit a second.
    step(dt, drive, pace) {
      const frame = { dt, tools: [] };
      this.refused = "";
      this.hands.forEach((hand, k) => {
        if (!hand.on) { frame.tools.push(null); return; }
        hand.at += Math.min(Math.max(hand.goal - hand.at, -pace * dt), pace * dt);
        const depths = {};
        for (const [name, tissue] of Object.entries(this.tissues)) {
          depths[name] = drive === "force" && name !== "published" ? tissue.depthFor(k, hand.at, dt) : Math.min(hand.at, tissue.body.deepest);
        }
        if (drive === "force" && this.tissues.published) depths.published = Math.min(depths[this.lead], this.tissues.published.body.deepest);
        frame.tools.push([hand.x, hand.y, depths]);
      });
      this.apply(frame);
      this._keep(frame);
    }

    // Carries out a frame, kept or new: what is not touched is let go.
    apply(frame) {
      for (const [name, tissue] of Object.entries(this.tissues)) {
        frame.tools.forEach((tool, k) => {
          if (tool) {
            const why = tissue.touch(k, tool[0], tool[1], tool[2][name] ?? 0);
            if (why && name === this.lead) this.refused = why;
          } else if (tissue.tools[k].phase === "pressed") {
            const fades = tissue.relaxation.strength.length || tissue.relaxation.eta;
            tissue.release(k, fades ? null : LET_GO);
          }
        });
        tissue.advance(frame.dt);
      }
      this.time += frame.dt;
    }

    _keep(frame) {
      const { force, tools } = this.shown;
      frame.time = this.time;
      frame.rows = tools.map((tool, k) => (tool.phase === "pressed" ? [k, tool.x, tool.y, tool.depth, force[k]] : null)).filter(Boolean);
      this.record.push(frame);
      while (this.record.length && this.record[0].time < this.time - KEPT) this.record.shift();
    }

    // The last press of a tool, from rest: at most so many rows of [seconds, depth in m].
    history(k, most) {
      let end = this.record.length;
      const row = (frame) => frame.rows.find(([tool]) => tool === k);
      while (end > 0 && !row(this.record[end - 1])) end--;
      let start = end;
      while (start > 0 && row(this.record[start - 1])) start--;
      const begin = this.record[start] && this.record[start].time - this.record[start].dt, every = Math.max(1, Math.ceil((end - start) / (most - 1)));
      const kept = this.record.slice(start, end).filter((_, at, all) => at % every === every - 1 || at === all.length - 1);
      return { begin, rows: kept.map((frame) => [frame.time - begin, row(frame)[3]]), alone: kept.every((frame) => frame.rows.length === 1) };
    }

    // The record as the lines of a CSV file.
    csv() {
      const lines = ["time_s,tool,x_mm,y_mm,depth_mm,force_N"];
      for (const { time, rows } of this.record) {
        for (const [k, x, y, depth, force] of rows) {
          lines.push([time.toFixed(5), k, (1e3 * x).toFixed(4), (1e3 * y).toFixed(4), (1e3 * depth).toFixed(5), force.toFixed(6)].join(","));
        }
      }
      return lines.join("\n") + "\n";
    }
  }

  return { Bench, MOST };
})();
if (typeof module !== "undefined") module.exports = Hands;
