"use strict";
// Hands on several tissues at once (the wave, the wave with an effect, finite elements, the published membrane): where
// each tool is wanted, how fast it gets there, and the record of it. No drawing, no events.
const Hands = (() => {
  const MOST = 4, KEPT = 600, LONGEST = 3600, LET_GO = 12;

  class Bench {
    // `tissues` by name; `lead` is the name of the one whose answer is shown.
    constructor(tissues, lead) {
      this.tissues = tissues; this.lead = lead; this.time = 0;
      this.hands = Array.from({ length: MOST }, () => ({ on: false, who: 0, x: 0, y: 0, goal: 0, at: 0, stay: false }));
      this.record = []; this.whole = null; this.refused = ""; this.task = null; this.hover = null;
    }

    get shown() { return this.tissues[this.lead]; }
    get busy() { return this.shown.tools.filter((tool) => tool.phase !== "idle").length; }

    // A tool for a press at a place, or -1 where all press: the one whose dent is there, one at rest, or else the one
    // with the least dent left, which is then gone.
    free(x, y) {
      const left = (k) => {
        const tool = this.shown.tools[k];
        if (tool.phase !== "returning") return 0;
        return Math.hypot(x - tool.x, y - tool.y) <= this.shown.body.toolRadius ? -1 : tool.elastic;
      };
      const off = this.hands.map((hand, k) => k).filter((k) => !this.hands[k].on);
      return off.reduce((best, k) => (best < 0 || left(k) < left(best) ? k : best), -1);
    }

    // A hand is known by the lowest number that no other has, whichever tool it takes.
    put(k, x, y, goal) {
      const hand = this.hands[k], taken = this.hands.filter((one) => one.on).map((one) => one.who);
      if (!hand.on) Object.assign(hand, { on: true, at: 0, who: [0, 1, 2, 3].find((number) => !taken.includes(number)) });
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
      frame.rows = tools.map((tool, k) => (tool.phase === "pressed" ? [k, tool.x, tool.y, tool.depth, force[k], this.hands[k].who, tool.rested] : null)).filter(Boolean);
      frame.air = this.hover && !frame.rows.length ? [0, ...this.hover, 0, 0, 0] : null;
      if (this.task) {
        frame.targets = this.task.current;
        this.task.look(tools, this.time);
      }
      this.record.push(frame);
      if (this.task?.done) this.whole ??= this.record.slice();
      const from = Math.min(this.time - KEPT, this.task && !this.task.done ? Math.max(this.task.start ?? this.time, this.time - LONGEST) : this.time);
      while (this.record.length && this.record[0].time < from) this.record.shift();
    }

    // The last press of a tool, and whether it was from rest: at most so many rows of [seconds, depth in m].
    history(k, most) {
      let end = this.record.length;
      const row = (frame) => frame.rows.find(([tool]) => tool === k);
      while (end > 0 && !row(this.record[end - 1])) end--;
      let start = end;
      while (start > 0 && row(this.record[start - 1])) start--;
      const begin = this.record[start] && this.record[start].time - this.record[start].dt, every = Math.max(1, Math.ceil((end - start) / (most - 1)));
      const kept = this.record.slice(start, end).filter((_, at, all) => at % every === every - 1 || at === all.length - 1);
      const rested = kept.every((frame) => row(frame)[6]);
      return { begin, rested, rows: kept.map((frame) => [frame.time - begin, row(frame)[3]]), alone: kept.every((frame) => frame.rows.length === 1) };
    }

    // The record as the lines of a CSV file; of a task with the target that was shown, and ending with it.
    csv() {
      const lines = ["time_s,tool,x_mm,y_mm,depth_mm,force_N,target,target_x_mm,target_y_mm,target_depth_mm"];
      for (const { time, rows, air, targets } of this.whole ?? this.record) {
        for (const [, x, y, depth, force, who] of air ? [air] : rows) {
          const target = targets?.[Math.min(who, targets.length - 1)];
          const aim = target ? [target.number, ...[target.x, target.y, target.depth].map((part) => (1e3 * part).toFixed(3))] : ["", "", "", ""];
          lines.push([time.toFixed(5), who, (1e3 * x).toFixed(4), (1e3 * y).toFixed(4), (1e3 * depth).toFixed(5), force.toFixed(6), ...aim].join(","));
        }
      }
      return lines.join("\n") + "\n";
    }
  }

  // Targets one after the other: `together` of them at once, each held to its depth for a while.
  class Task {
    constructor(kind, side, deepest) {
      const turn = (k, count, radius) => [0.5 * side + radius * Math.cos((2 * Math.PI * k) / count), 0.5 * side + radius * Math.sin((2 * Math.PI * k) / count)];
      const target = ([x, y], share) => ({ x, y, depth: share * deepest });
      const make = {
        touch: () => [0, 3, 6, 1, 4, 7].map((k, n) => target(turn(k, 8, 0.3 * side), [0.3, 0.5, 0.4, 0.6, 0.35, 0.55][n])),
        trace: () => Array.from({ length: 25 }, (_, k) => target(turn(k, 24, 0.24 * side), 0.4)),
        hands: () => [0, 1, 2].flatMap((k) => [target(turn(k, 6, 0.3 * side), 0.4), target(turn(k + 3, 6, 0.3 * side), 0.4)]),
      };
      this.targets = make[kind]().map((one, number) => ({ ...one, number }));
      this.together = kind === "hands" ? 2 : 1; this.dwell = kind === "trace" ? 0 : 0.3; this.within = kind === "trace" ? 0.3 : 0.1;
      this.at = 0; this.since = null; this.start = null; this.end = null;
    }

    get current() { return this.targets.slice(this.at, this.at + this.together); }
    get done() { return this.at >= this.targets.length; }

    look(tools, time) {
      if (this.done) return;
      this.start ??= time;
      const met = ({ x, y, depth }) => tools.some((tool) => tool.phase === "pressed" && Math.hypot(tool.x - x, tool.y - y) < 2.5e-3
        && Math.abs(tool.depth - depth) <= this.within * depth);
      if (!this.current.every(met)) { this.since = null; return; }
      this.since ??= time;
      if (time - this.since < this.dwell) return;
      this.at += this.together;
      this.since = null;
      if (this.done) this.end = time;
    }
  }

  return { Bench, Task, MOST };
})();
if (typeof module !== "undefined") module.exports = Hands;
