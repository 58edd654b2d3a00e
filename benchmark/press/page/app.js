"use strict";
// The page: what the controls mean, what is drawn each frame, what is read out.
(() => {
  const SIDE = 49e-3, SPACING = 1e-3, GAP = 9, PLATE = 1.6, SECONDS = 10, CENTRE = SIDE / 2, MOST_NAME = 0.24, MIN_NAME = 90, STILL = 1e-4;
  const SKIN = { epidermis: "#f6cfb0", dermis: "#e9a493", subcutaneous_fat: "#f3dc9a", fat: "#f3dc9a", gel: "#c9d7dd", skin: "#efc0ab" };
  const OTHERS = ["#cfd8dc", "#bccbd2", "#a9bdc7", "#d8d2c4"];
  const get = (id) => document.getElementById(id);
  const data = JSON.parse(get("data").textContent), calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const canvas = get("view"), grid = Wave.grid(SIDE, SIDE, SPACING), P = grid.xs.length, Q = grid.ys.length;
  const rows = grid.ys.slice(), shades = new Map();
  // A colour by its name; on paper the light one, which the page's first rule has.
  const colours = () => (state.paper ? document.styleSheets[0].cssRules[0].style : getComputedStyle(document.documentElement));
  const shade = (name) => shades.get(name) ?? shades.set(name, colours().getPropertyValue("--" + name).trim()).get(name);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { shades.clear(); state.told = {}; });
  const value = (id) => Number(get(id).value), chosen = (name) => document.querySelector(`input[name="${name}"]:checked`).value;
  const mm = (metres) => 1e3 * metres, FLAT = new Float64Array(P * Q);

  let renderer, undrawn = "";
  try { renderer = new Scene.Renderer(canvas); } catch (error) { undrawn = `No drawing here: ${error.message}.`; }
  const gl = renderer?.gl, camera = new Scene.Camera();
  const state = {
    renderer, bench: null, specimen: null, bodies: null, slabs: [], plate: null, sheet: null, ribbons: [], tools: [], faces: null, fem: null, values: null,
    paused: false, slow: false, replay: null, demo: true, last: 0, active: 0, cost: 0, errorScale: 0.0025, traces: [], frames: [], orbit: null, pointers: new Map(), script: null, told: {}, read: 0, paper: false, rest: { at: [], since: 0, told: true },
  };
  // A text that has not changed costs nothing: without a graphics card every change is a picture drawn anew.
  const tell = (id, text) => { if (state.told[id] !== text) { state.told[id] = text; get(id).textContent = text; } };

  const named = (id, text) => { if (state.told[id + "-name"] !== text) { state.told[id + "-name"] = text; get(id).setAttribute("aria-label", text); } };
  const stack = () => state.specimen.layers.map(({ name, thickness_m }) => [name.replaceAll("_", " "), `${+mm(thickness_m).toPrecision(3)} mm`]);

  const inOneLine = ([name, thick]) => `\u2068${name}\u2069 ${thick}`;  // a name from right to left keeps its number behind it

  // ---- what is pressed
  function choose(index) {
    const one = (state.specimen = data.specimens[index]);
    one.made ??= {
      wave: new Wave.RadialBody(one.wave), fem: one.fem && new Wave.RadialBody(one.fem.table), after: one.after && new Wave.RadialBody(one.after.table),
    };
    state.bodies = one.made;
    get("state").hidden = !one.after;
    get("key-after").hidden = !one.after;
    if (one.after) get("effect").textContent = "with " + one.effects.map((name) => name.replaceAll("_", " ")).join(", ");
    get("remarks").textContent = one.remarks.join(" ");
    get("stack").textContent = `Layers from the top: ${stack().map(inOneLine).join(", ")}.`;
    state.told.fit = "";
    const word = (kind, textContent) => Object.assign(document.createElement(kind), { textContent });
    get("layers").replaceChildren(...stack().map(([name, thick]) => {
      const label = document.createElement("span");
      label.append(word("bdi", name), word("i", thick));
      return label;
    }));
    const own = one.memory;
    get("fade").value = own.strength.length ? 0 : get("fade").value;
    get("fade").disabled = own.strength.length > 0;
    const size = one.layers.length * P * Q;
    Object.assign(state, { faces: new Float64Array(size), fem: new Float64Array(size), values: new Float64Array(size), errorScale: 0.0025 });
    if (renderer) {
      state.slabs = one.layers.map(() => new Scene.Slab(gl, P, Q, renderer.software ? 4 : 8));
      state.plate ??= new Scene.Slab(gl, P, Q, 1);
      state.sheet ??= new Scene.Slab(gl, P, Q, 1);
      state.ribbons = one.layers.map(() => [new Scene.Ribbon(gl, P), new Scene.Ribbon(gl, P)]);
      state.rings ??= Array.from({ length: 6 }, () => new Scene.Cylinder(gl));
      if (!state.tools.length) state.tools = Array.from({ length: Hands.MOST }, () => new Scene.Cylinder(gl));
    }
    restart();
    aim();  // a tool that presses goes to the same share of what this tissue can be pressed to, which is what Target says
  }

  function memory(of) {
    const share = value("fade") / 100;
    if (of.strength.length || of.retardation_s || !share) return of;
    return { strength: [share], time_s: [tau()], retardation_s: 0 };
  }

  function restart() {
    const { specimen: one, bodies } = state, tissue = (body, of) => new Wave.InteractiveTissue(body, grid, Hands.MOST, memory(of));
    const tissues = { wave: tissue(bodies.wave, one.memory) };
    if (bodies.fem) tissues.fem = tissue(bodies.fem, one.memory);
    if (bodies.after) tissues.after = tissue(bodies.after, one.after.memory);
    if (get("beside").checked) {
      const kind = get("corrected").checked ? "corrected" : "printed";
      tissues.published = new Wave.InteractiveTissue(new Wave.PublishedBody(data.published[kind]), grid, Hands.MOST, {});
    }
    const hands = state.bench?.hands;
    if (state.script) { state.script = null; hands[0].on = false; }  // what plays ends with the tissue it plays on
    state.bench = new Hands.Bench(tissues, bodies.after && chosen("state") === "after" ? "after" : "wave");
    const kind = get("task").value;
    state.bench.task = kind && !state.replay ? new Hands.Task(kind, SIDE, bodies.wave.deepest) : null;
    if (hands && !state.replay) state.bench.hands = hands.map((hand) => ({ ...hand, at: 0 }));
    state.traces = [];
    state.asked = null;
    shownSettings();
  }

  // ---- settings in words
  const tau = () => 0.05 * 400 ** (value("tau") / 100);
  const pace = () => 0.5e-3 * 60 ** (value("speed") / 100);
  const strongest = () => state.bodies.wave.force.at(-1);
  const goal = (share = 1) => (share * value("target") / 100) * (chosen("drive") === "force" ? strongest() : state.bodies.wave.deepest);
  const rate = () => (chosen("drive") === "force" ? (pace() / state.bodies.wave.deepest) * strongest() : pace());

  function shownSettings() {
    const force = chosen("drive") === "force";
    const say = (id, text) => { get(`${id}-shown`).textContent = text; get(id).setAttribute("aria-valuetext", text); };
    say("target", force ? `${goal().toPrecision(3)} N` : `${mm(goal()).toFixed(2)} mm`);
    say("speed", `${mm(pace()).toPrecision(2)} mm/s`);
    say("cut", get("follow").checked ? "at the tool" : value("cut") ? `${Math.round(0.49 * value("cut"))} mm` : "none");
    say("peel", value("peel") ? `${((GAP * value("peel")) / 100).toFixed(1)} mm` : "none");
    const own = state.specimen.memory.strength, share = own.reduce((sum, part) => sum + part, 0);
    say("fade", own.length ? `${Math.round(100 * share)} %, its own` : value("fade") ? `${value("fade")} % fades` : "none");
    say("tau", own.length ? `${Math.round(Math.min(...state.specimen.memory.time_s))} s` : `${tau().toPrecision(2)} s`);
    get("figure").hidden = get("captions").hidden = !get("beside").checked;
  }

  // ---- one frame
  function advance(dt) {
    const { bench } = state;
    if (state.replay) {
      const frame = state.replay.frames[state.replay.next++];
      if (frame) bench.apply(frame); else { state.replay = null; restart(); }
    } else {
      if (state.script) state.script(dt);
      state.live?.lead();
      bench.step(dt, chosen("drive"), rate());
    }
    const trace = { time: bench.time, led: state.live?.led ?? null };
    for (const name of ["wave", "fem", "after"]) trace[name] = bench.tissues[name]?.force.reduce((sum, force) => sum + force, 0);
    state.traces.push(trace);
    while (state.traces[0].time < bench.time - SECONDS) state.traces.shift();
  }

  function cutAt() {
    if (!get("follow").checked) return (value("cut") / 100) * SIDE * 0.98;
    const tool = state.bench.shown.tools[state.active];
    return Math.min(tool.phase === "idle" && !state.bench.hands[state.active].on ? CENTRE : state.bench.hands[state.active].y, SIDE * 0.98);
  }

  function computed() {
    const { bench, faces, fem, values } = state, cut = cutAt();
    for (let j = 0; j < Q; j++) rows[j] = Math.max(grid.ys[j], cut);
    const start = performance.now();
    bench.shown.draw(faces.fill(0), grid.xs, rows);
    state.cost += 0.02 * (performance.now() - start - state.cost);
    const compared = bench.tissues.fem && bench.busy === 1;
    if (compared) bench.tissues.fem.draw(fem.fill(0), grid.xs, rows);
    const deepest = bench.shown.body.deepest, wrong = chosen("colour") === "error";
    let worst = 0, depth = 0;
    for (let k = 0; k < faces.length; k++) {
      if (faces[k] > depth) depth = faces[k];
      if (compared) worst = Math.max(worst, Math.abs(faces[k] - fem[k]));
    }
    const share = compared && depth > 1e-6 ? worst / depth : 0;
    while (share > state.errorScale && state.errorScale < 1) state.errorScale *= 2;
    const scale = state.errorScale * Math.max(depth, 1e-6);
    for (let k = 0; k < faces.length; k++) values[k] = wrong ? (compared ? (faces[k] - fem[k]) / scale : 0) : faces[k] / deepest;
    return { cut, compared, share, depth, scale, wrong, deepest };
  }

  function drawn(now) {
    renderer.resize();
    if (renderer.software) renderer.ground = [...Scene.rgb(shade(state.paper ? "paper" : "raised")), 1];
    renderer.clear();
    const low = Scene.rgb(shade("fem")), high = Scene.rgb(shade("wave")), beside = state.bench.tissues.published;
    const layers = state.specimen.layers, hole = state.specimen.support === "hole", total = mm(layers.reduce((sum, layer) => sum + layer.thickness_m, 0));
    get("layers").hidden = Boolean(beside);
    fit(beside, total);
    renderer.begin(camera, 0, beside ? 0.5 : 1, low, high);
    const lift = (GAP * value("peel")) / 100, size = P * Q, count = layers.length;
    let depth = 0;
    layers.forEach((layer, l) => {
      const raised = lift * (count - 1 - l), top = -depth + raised;
      depth += mm(layer.thickness_m);
      const last = l === count - 1, below = last ? (hole ? l * size : null) : (l + 1) * size;
      const slab = state.slabs[l], covered = l > 0 && lift === 0;
      slab.fill(grid.xs, rows, state.faces, state.values, l * size, below, top, -depth + raised, covered);
      const colour = Scene.rgb(SKIN[layer.name] ?? OTHERS[l % OTHERS.length]);
      renderer.draw(slab, colour, { mode: now.wrong ? 1 : 0, lines: now.wrong ? 0 : 8 });
      if (now.compared) lines(l, top, now, low, high);
    });
    if (!hole) {
      state.plate.fill(grid.xs, rows, FLAT, FLAT, 0, null, -depth, -depth - PLATE, true);
      renderer.draw(state.plate, Scene.rgb(shade("tool")));
    }
    targets(lift * (count - 1));
    tools(state.bench.shown, lift * (count - 1));
    names(now.cut, lift, beside ? 0.5 : 1);
    if (beside) published(beside, low, high);
  }

  // The camera far enough away for the block, cut in the middle or whole, to stand in its part of the picture beside the names of its layers.
  function fit(beside, total) {
    const { clientWidth, clientHeight } = renderer.size, wide = clientWidth * (beside ? 0.5 : 1), labels = [...get("layers").children];
    const front = !beside && get("follow").checked ? CENTRE : 0, key = [data.specimens.indexOf(state.specimen), clientWidth, clientHeight, Boolean(beside), front].join();
    if (key !== state.told.fit) {
      Object.assign(state.told, { fit: key, names: "" });
      labels.forEach((label) => { label.style.maxWidth = ""; label.style.left = "0"; });
      const room = Math.min(Math.max(...labels.map((label) => label.offsetWidth)), MOST_NAME * wide), right = room ? 1 - (2 * (room + 14)) / wide : 0.95;
      const corners = [0, SIDE].flatMap((x) => [front, SIDE].flatMap((y) => [0, -total - PLATE].map((z) => [mm(x), mm(y), z])));
      state.fit = new Scene.Camera().fit(corners, [mm(CENTRE), mm(CENTRE) * 1.15, beside ? -7 : 0.05 * total], mm(SIDE), wide / clientHeight, -0.95, right);
    }
    Object.assign(camera, state.fit);
  }

  // The layers' names beside the right end of the cut, as wide as the picture lets them be.
  function names(cut, lift, share) {
    const { layers } = state.specimen, labels = get("layers"), { clientWidth, clientHeight } = renderer.size, wide = clientWidth * share, high = clientHeight;
    const key = [data.specimens.indexOf(state.specimen), cut, lift, wide, high, camera.azimuth, camera.elevation, camera.zoom, camera.target, camera.size].join();
    if (key === state.told.names) return;
    state.told.names = key;
    let depth = 0, free = -Infinity;
    layers.forEach((layer, l) => {
      const middle = -(depth + 0.5 * mm(layer.thickness_m)) + lift * (layers.length - 1 - l), at = camera.project([mm(SIDE), mm(cut), middle], wide / high);
      depth += mm(layer.thickness_m);
      const y = Math.max(0.5 * (1 - at[1]) * high, free + 15);
      free = y;
      const left = Math.min(Math.max(0.5 * (1 + at[0]) * wide + 6, 6), wide - MIN_NAME);
      Object.assign(labels.children[l].style, { left: `${left}px`, top: `${y - 9}px`, maxWidth: `${wide - left - 6}px` });
    });
  }

  function lines(l, top, now, low, high) {
    const along = grid.xs.map(mm), at = (faces) => grid.xs.map((_, i) => top - mm(faces[l * P * Q + i * Q]));
    const [slow, fast] = state.ribbons[l], y = mm(now.cut) - 0.06;
    fast.fill(along, y, at(state.faces), 0.055, false);
    slow.fill(along, y - 0.04, at(state.fem), 0.1, true);
    renderer.draw(fast.mesh, high, { mode: 3 });
    renderer.draw(slow.mesh, low, { mode: 3 });
  }

  // The targets of a task: those wanted now, and the next few.
  function targets(raised) {
    const { task } = state.bench;
    if (!task || task.done) return;
    task.targets.slice(task.at, task.at + state.rings.length).forEach(({ x, y }, k) => {
      const wanted = k < task.together;
      state.rings[k].fill(mm(x), mm(y), raised + 0.02, wanted ? 2.5 : 1.2, 0.12);
      renderer.draw(state.rings[k].mesh, Scene.rgb(shade(wanted ? "good" : "muted")), { alpha: wanted ? 0.75 : 0.35 });
    });
  }

  function asked(task) {
    if (task.done) return `Done in ${(task.end - task.start).toFixed(1)} s, where its record ends. Save it and run: tissuebench assess press-record.csv`;
    const [{ depth }] = task.current, what = task.together > 1 ? "both green targets" : "the green target";
    return `Press ${what} to ${mm(depth).toFixed(2)} mm (${task.at + 1} of ${task.targets.length}); wheel, D and U change the depth.`;
  }

  function tools(tissue, raised) {
    tissue.tools.forEach((tool, k) => {
      if (tool.phase !== "pressed") return;
      const radius = mm(tissue.body.toolRadius) || 1.2;
      state.tools[k].fill(mm(tool.x), mm(tool.y), raised - mm(tool.depth) + 0.03, radius, 20);
      renderer.draw(state.tools[k].mesh, Scene.rgb(shade("tool")), { alpha: 0.42 });
    });
  }

  function published(tissue, low, high) {
    const size = P * Q, faces = tissue.draw(new Float64Array(size), grid.xs, rows), wrong = chosen("colour") === "error", most = state.bench.shown.body.deepest;
    renderer.begin(camera, 0.5, 1, low, high);
    state.sheet.fill(grid.xs, rows, faces, faces.map((deflection) => deflection / most), 0, 0, 0, -0.5);
    renderer.draw(state.sheet, Scene.rgb(SKIN.skin), wrong ? { mode: 2 } : { mode: 0, lines: 8 });  // it has no error: nothing asks it for one
    tools(tissue, 0);
  }

  // ---- read-out
  function read(now) {
    const { bench } = state, force = bench.shown.force.reduce((sum, part) => sum + part, 0), tool = bench.shown.tools[state.active];
    const held = tool.phase === "pressed" ? tool.depth : now.depth;
    const turn = state.read++, due = state.manual || turn % (renderer?.software ? 6 : 2) === 0;
    if (!due) return;
    tell("force", force.toFixed(2));
    tell("depth", mm(held).toFixed(2));
    const fem = now.compared && bench.tissues.fem.force.reduce((sum, part) => sum + part, 0);
    tell("fem-force", now.compared ? fem.toFixed(2) : "–");
    tell("error", now.compared && now.depth > 1e-5 ? (100 * now.share).toFixed(2) : "–");
    scale(now);
    hear(now, held, force, fem);
    const two = bench.busy > 1 && state.bench.tissues.fem ? "Finite elements were run for one tool: none of theirs with two." : "";
    const assumed = bench.lead === "after" && now.compared ? "The finite elements are those of the model as it was assumed: the error shows the effect." : "";
    const shallow = bench.tissues.published && tool.depth > bench.tissues.published.body.deepest ? "Eq. (8) of the article has no answer deeper than 1 mm." : "";
    tell("note", state.said ? state.said : state.replay ? "Replay" : bench.refused ? `The tool stays where it was: ${bench.refused}.` : shallow || (bench.task ? asked(bench.task) : two || assumed || undrawn));
    if (state.manual || turn % 12 === 0) { trace(); law(now); }
    const fast = state.cost, slow = state.specimen.fem;
    if (turn % 30 === 0 && fast > 0) {
      get("time").innerHTML = `Wave, in this page now: <b>${fast.toFixed(fast < 0.1 ? 3 : 2)} ms</b> for ${(state.faces.length).toLocaleString("en")} points.`
        + (slow ? ` Finite elements, when this page was made: <b>${(1e3 * slow.wall_s / slow.levels).toFixed(0)} ms</b> for each of ${slow.levels} depths, ${slow.unknowns.toLocaleString("en")} unknowns.` : "")
        + (renderer?.rough || renderer?.detail < 0.6 ? " Drawn with fewer points and pixels than computed, since pictures came too slowly." : "");
    }
  }

  // Told to who listens: the figures once a press has come to rest for a second, none while it moves.
  function hear(now, held, force, fem) {
    const { rest, bench } = state, at = bench.shown.tools.filter((tool) => tool.phase === "pressed").flatMap(({ x, y, depth }) => [x, y, depth]);
    const moved = at.length !== rest.at.length || at.some((part, k) => Math.abs(part - rest.at[k]) > STILL);
    if (moved) { Object.assign(rest, { at, since: state.last, told: false }); tell("told", ""); }
    if (!at.length || rest.told || state.last - rest.since < 1e3) return;
    rest.told = true;
    const versus = now.compared ? `; finite elements ${fem.toFixed(2)} N, wave's largest error ${(100 * now.share).toFixed(2)} % of depth` : "";
    tell("told", `Force ${force.toFixed(2)} N at ${mm(held).toFixed(2)} mm${versus}.`);
  }

  function scale(now) {
    const bound = +(100 * state.errorScale).toPrecision(2), key = [now.wrong, bound, now.deepest].join();
    if (key === state.told.scale) return;
    state.told.scale = key;
    const context = plain(get("scale")), wide = 220, ramp = context.createLinearGradient(0, 0, wide, 0);
    const stops = now.wrong ? [[0, shade("fem")], [0.5, "#eeece8"], [1, shade("wave")]] : [[0, SKIN.epidermis], [0.38, "#ed6b5c"], [0.7, "#9e2b7a"], [1, "#33126b"]];
    stops.forEach(([at, colour]) => ramp.addColorStop(at, colour));
    context.fillStyle = ramp;
    context.fillRect(0, 0, wide, 10);
    get("scale-low").textContent = now.wrong ? `−${bound}` : "0";
    get("scale-name").textContent = now.wrong ? "wave too deep by, % of depth" : "deflection";
    get("scale-high").textContent = now.wrong ? `+${bound}` : `${mm(now.deepest).toFixed(1)} mm`;
  }

  // A small picture drawn by the processor: without a graphics card anything else is slower.
  const plain = (target) => target.getContext("2d", { willReadFrequently: Boolean(renderer?.software) });

  function chart(id, x, y, unit) {
    const target = get(id), scale = Math.min(devicePixelRatio || 1, 2), wide = target.clientWidth, high = target.clientHeight;
    if (target.width !== Math.round(wide * scale)) { target.width = Math.round(wide * scale); target.height = Math.round(high * scale); }
    const context = plain(target), bottom = 15, top = 6, ticks = [0, 0.5, 1].map((part) => `${+(part * y).toPrecision(2)}`);
    context.font = state.font ??= `10px ${getComputedStyle(document.body).fontFamily}`;
    const left = 8 + Math.max(18, ...ticks.map((text) => context.measureText(text).width));
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, wide, high);
    const px = (v) => left + ((v - x[0]) / (x[1] - x[0])) * (wide - left - 4), py = (v) => high - bottom - (v / y) * (high - bottom - top);
    context.strokeStyle = shade("grid"); context.fillStyle = shade("muted"); context.lineWidth = 1;
    ticks.forEach((text, k) => {
      context.beginPath(); context.moveTo(left, py(0.5 * k * y)); context.lineTo(wide - 4, py(0.5 * k * y)); context.stroke();
      context.textAlign = "right"; context.fillText(text, left - 4, py(0.5 * k * y) + 3);
    });
    context.textAlign = "right"; context.fillText(unit, wide - 4, high - 3);
    const line = (points, colour, width = 1.8) => {
      context.beginPath();
      points.forEach(([a, b], k) => (k ? context.lineTo(px(a), py(b)) : context.moveTo(px(a), py(b))));
      Object.assign(context, { strokeStyle: shade(colour), lineWidth: width });
      context.stroke();
    };
    const dot = (a, b, colour) => { context.beginPath(); context.arc(px(a), py(b), 3.6, 0, 7); context.fillStyle = shade(colour); context.fill(); };
    return { line, dot };
  }

  const LINES = [["after", "incomplete"], ["fem", "fem"], ["wave", "wave"]], CALLED = { after: "with the effect", fem: "by finite elements", wave: "by the wave" };
  const ladder = (most) => [1, 2, 5, 10].map((step) => step * 10 ** Math.floor(Math.log10(Math.max(most, 1e-3)))).find((step) => step >= most);

  // Where a moment stands on the trace: one that the bench led, at the bench's own time, as its measured force does.
  const instant = ({ time, led }) => (led === null ? time : led + state.live.shift);

  function trace() {
    const { traces, bench } = state, measured = state.live?.trace() ?? [];
    const most = Math.max(0.05, ...traces.flatMap((one) => LINES.map(([name]) => one[name] ?? 0)), ...measured.map(([, force]) => force));
    const { line, dot } = chart("trace", [bench.time - SECONDS, bench.time], ladder(most), "10 s");
    for (const [name, colour] of LINES) if (bench.tissues[name]) line(traces.map((one) => [instant(one), one[name]]), colour, name === "fem" ? 3.2 : 1.6);
    if (measured.length) line(measured.filter(([time]) => time > bench.time - SECONDS), "measured", 1.4);
    for (const [at, force] of state.asked?.points ?? []) if (at > bench.time - SECONDS) dot(at, force, "fem");
    const peak = (name) => Math.max(...traces.map((one) => one[name] ?? 0)).toFixed(2);
    named("trace", `Force in N, last 10 s: at most ${LINES.filter(([name]) => bench.tissues[name]).map(([name]) => `${peak(name)} ${CALLED[name]}`).join(", ")}.`);
  }

  function law(now) {
    const { bench } = state, names = LINES.filter(([name]) => bench.tissues[name]);
    const most = Math.max(...names.map(([name]) => bench.tissues[name].body.force.at(-1)));
    const { line, dot } = chart("law", [0, mm(now.deepest)], ladder(most), `${mm(now.deepest).toFixed(1)} mm`);
    named("law", `Force in N over depth: ${names.map(([name]) => `${bench.tissues[name].body.force.at(-1).toFixed(2)} at ${mm(bench.tissues[name].body.deepest).toFixed(1)} mm ${CALLED[name]}`).join(", ")}.`);
    for (const [name, colour] of names) {
      const { force, deepest } = bench.tissues[name].body, last = force.length - 1;
      line(Array.from({ length: 33 }, (_, k) => [(mm(deepest) * k) / 32, force[Math.round((k * last) / 32)]]), colour, name === "fem" ? 3.2 : 1.6);
      bench.tissues[name].tools.forEach((tool, k) => { if (tool.phase === "pressed" && name === bench.lead) dot(mm(tool.depth), bench.tissues[name].force[k], colour); });
    }
  }

  function tick(time) {
    const dt = Math.min((time - state.last) / 1e3, state.live ? 1 : 0.05);  // a bench does not wait for the page
    if (state.last) {
      state.frames.push(time - state.last);
      renderer?.pace(time - state.last);
    }
    if (state.frames.length > 1200) state.frames.splice(0, 600);
    state.last = time;
    if (dt > 0 && !state.paused) advance(state.slow ? dt / 5 : dt);
    const now = computed();
    if (renderer) drawn(now);
    read(now);
    if (!state.manual) requestAnimationFrame(tick);
  }

  // ---- on paper: light colours, and the tissue as a flat picture with its names, which a 3-D one is not printed as
  function paper(on) {
    state.paper = on;
    shades.clear();
    state.told = {};
    const now = computed();
    if (renderer) {
      drawn(now);
      const still = get("still"), context = still.getContext("2d"), { clientWidth, clientHeight } = renderer.size;
      Object.assign(still, { width: 2 * clientWidth, height: 2 * clientHeight });
      context.scale(2, 2);
      context.drawImage(canvas, 0, 0, clientWidth, clientHeight);
      Object.assign(context, { font: `12.5px ${getComputedStyle(document.body).fontFamily}`, fillStyle: shade("muted") });
      if (get("layers").offsetParent) stack().forEach(([name, thick], l) => {
        const { left, top, maxWidth } = get("layers").children[l].style, fits = (words) => context.measureText(words).width <= parseFloat(maxWidth);
        let words = inOneLine([name, thick]);
        for (let kept = name.length - 1; kept > 0 && !fits(words); kept--) words = inOneLine([`${name.slice(0, kept)}…`, thick]);
        context.fillText(words, parseFloat(left), parseFloat(top) + 12);
      });
    }
    scale(now); trace(); law(now);
  }
  addEventListener("beforeprint", () => paper(true));
  addEventListener("afterprint", () => paper(false));

  // ---- hands
  function place(event) {
    const box = canvas.getBoundingClientRect(), wide = state.bench.tissues.published ? 0.5 : 1;
    const across = (event.clientX - box.left) / box.width, raised = ((GAP * value("peel")) / 100) * (state.specimen.layers.length - 1);
    const within = (across % wide) / wide, hit = camera.hit(2 * within - 1, 1 - (2 * (event.clientY - box.top)) / box.height, (box.width * wide) / box.height, raised);
    return hit && [hit[0] / 1e3, hit[1] / 1e3];
  }
  const inside = (at) => at && at[0] >= 0 && at[0] <= SIDE && at[1] >= 0 && at[1] <= SIDE;
  const weight = (event) => (event.pointerType === "pen" && event.pressure > 0 ? Math.min(1, 0.2 + event.pressure) : 1);

  function takeOver() {
    if (!state.demo) return;
    state.demo = false; state.script = null;
    state.bench.hands.forEach((hand) => { hand.on = false; });
  }

  canvas.addEventListener("pointerdown", (event) => {
    const at = place(event);
    canvas.setPointerCapture(event.pointerId);
    if (!inside(at) || event.button) { state.orbit = { id: event.pointerId, x: event.clientX, y: event.clientY }; return; }
    takeOver();
    state.said = "";
    const near = state.bench.hands.findIndex((hand) => hand.on && hand.stay && Math.hypot(hand.x - at[0], hand.y - at[1]) < Math.max(2e-3, state.bodies.wave.toolRadius));
    const k = near >= 0 ? near : state.bench.free(...at);
    if (k < 0) { state.said = "all four tools press; let one go"; return; }
    state.active = k;
    state.pointers.set(event.pointerId, k);
    state.bench.put(k, at[0], at[1], goal(weight(event)));
  });
  canvas.addEventListener("pointermove", (event) => {
    const k = state.pointers.get(event.pointerId), at = place(event);
    state.bench.hover = inside(at) && event.pointerType !== "touch" ? at : null;
    if (k !== undefined && at) {
      const limit = (part) => Math.min(Math.max(part, 0), SIDE);
      state.bench.put(k, limit(at[0]), limit(at[1]), event.pointerType === "pen" ? goal(weight(event)) : state.bench.hands[k].goal);
    } else if (state.orbit?.id === event.pointerId) {
      turn(-(event.clientX - state.orbit.x) * 0.006, (event.clientY - state.orbit.y) * 0.005);
      Object.assign(state.orbit, { x: event.clientX, y: event.clientY });
    }
  });
  const lift = (event) => {
    const k = state.pointers.get(event.pointerId);
    state.pointers.delete(event.pointerId);
    if (state.orbit?.id === event.pointerId) state.orbit = null;
    if (k === undefined) return;
    state.bench.hands[k].stay = get("stay").checked;
    if (!get("stay").checked) state.bench.lift(k);
  };
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, lift);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    if (state.pointers.size) deeper(event.deltaY > 0 ? 4 : -4); else camera.zoom = Math.min(Math.max(camera.zoom * Math.exp(-event.deltaY * 0.001), 0.5), 4);
  }, { passive: false });

  function turn(across, up) {
    camera.azimuth = Math.min(Math.max(camera.azimuth + across, -1.4), 1.4);
    camera.elevation = Math.min(Math.max(camera.elevation + up, 0.06), 1.5);
  }

  function deeper(steps) {
    get("target").value = value("target") + steps;
    aim();
  }

  function aim() {
    shownSettings();
    for (const hand of state.bench.hands) if (hand.on) hand.goal = goal();
  }

  const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  canvas.addEventListener("keydown", (event) => {
    const way = ARROWS[event.key], hand = state.bench.hands[state.active];
    if (way && event.shiftKey) turn(0.08 * way[0], -0.06 * way[1]);
    else if (way) {
      takeOver();
      const from = hand.on ? hand : { x: CENTRE, y: CENTRE }, limit = (part) => Math.min(Math.max(part, 0), SIDE);
      state.bench.put(state.active, limit(from.x + way[0] * 1e-3), limit(from.y + way[1] * 1e-3), goal());
    } else if (event.key === "d" || event.key === "PageDown") deeper(4);
    else if (event.key === "u" || event.key === "PageUp") deeper(-4);
    else if (event.key === "Escape") { takeOver(); state.bench.hands.forEach((one) => { one.on = false; }); }
    else if (event.key === " ") get("pause").click();
    else return;
    event.preventDefault();
  });

  // ---- controls
  const toggle = (id, key) => get(id).addEventListener("click", () => {
    state[key] = !state[key];
    get(id).setAttribute("aria-pressed", String(state[key]));
  });
  toggle("pause", "paused");
  toggle("slow", "slow");
  get("replay").addEventListener("click", () => {
    const frames = state.bench.record;
    if (!frames.length) return;
    takeOver();
    state.bench.hands.forEach((hand) => { hand.on = false; });
    state.replay = { frames, next: 0 };
    restart();
  });
  get("record").addEventListener("click", () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([state.bench.csv()], { type: "text/csv" }));
    link.download = "press-record.csv";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1e3);
  });
  get("home").addEventListener("click", () => {
    Object.assign(camera, { azimuth: -0.42, elevation: 0.5, zoom: 1 });
    for (const [id, at] of [["peel", 0], ["cut", 0]]) get(id).value = at;
    get("follow").checked = true;
    state.replay = null;
    state.bench.hands.forEach((hand) => { hand.on = false; });
    restart();
  });
  get("specimen").addEventListener("change", () => choose(Number(get("specimen").value)));
  get("cut").addEventListener("input", () => { get("follow").checked = false; shownSettings(); });
  for (const id of ["follow", "peel"]) get(id).addEventListener("input", shownSettings);
  for (const id of ["target", "speed"]) get(id).addEventListener("input", aim);
  get("task").addEventListener("change", () => {
    takeOver();
    state.bench.hands.forEach((hand) => { hand.on = false; });
    if (get("task").value) { get("follow").checked = false; get("cut").value = 0; }
    restart();
  });
  for (const id of ["fade", "tau", "beside", "corrected"]) get(id).addEventListener("change", restart);
  for (const radio of document.querySelectorAll('input[name="drive"]')) radio.addEventListener("change", () => { restart(); aim(); });
  for (const radio of document.querySelectorAll('input[name="state"]')) radio.addEventListener("change", () => { state.bench.lead = chosen("state") === "after" ? "after" : "wave"; });
  get("play").addEventListener("click", () => {
    takeOver();
    const body = state.bench.tissues.published.body, most = Math.min(body.deepest, state.bodies.wave.deepest);
    let time = 0;
    state.active = 0;
    state.script = (dt) => {  // eq. (7): down and back in half a period, its printed number read per second
      time += dt;
      const depth = most * Math.sin(1.7409 * time), hand = state.bench.hands[0];
      if (depth <= 0 && time > 0.1) { hand.on = false; state.script = null; return; }
      state.bench.put(0, CENTRE, CENTRE, depth);
      hand.at = depth;
    };
  });

  // ---- the finite elements, asked for the last press as it was made (a served page only)
  let line = null;
  function ask() {
    const { begin, rows, alone, rested } = state.bench.history(state.active, 60), say = (text) => { state.said = text; };
    if (rows.length < 2) return say("Press first: the finite elements follow the last press.");
    if (!alone) return say("The finite elements follow one tool alone.");
    if (!rested) return say("The finite elements follow a press from rest, and this one met the dent of another.");
    const series = memory(state.specimen.memory), question = { press: data.specimens.indexOf(state.specimen), history: rows };
    if (!state.specimen.memory.strength.length) Object.assign(question, { strength: series.strength, time_s: series.time_s });
    const send = () => { say("The finite elements are at work…"); line.send(JSON.stringify(question)); };
    if (!line || line.readyState > 1) {
      line = new WebSocket(`ws://${location.host}${location.pathname}fem`);
      line.addEventListener("open", send);
      line.addEventListener("close", () => say("The server has ended: the page goes on without it."));
    } else send();
    line.onmessage = (event) => {
      const answer = JSON.parse(event.data);
      if (answer.error) return say(`The finite elements gave no answer: ${answer.error}`);
      const trail = state.bench.record.filter((frame) => frame.rows.length), at = (time) => trail.findLast((frame) => frame.time <= time + 1e-9)?.rows[0][4] ?? 0;
      const most = Math.max(...answer.force_N), apart = Math.max(...answer.time_s.map((time, k) => Math.abs(at(begin + time) - answer.force_N[k])));
      state.asked = { points: answer.time_s.map((time, k) => [begin + time, answer.force_N[k]]), apart: apart / most, answer };
      return say(`Finite elements, asked now for this press: ${(answer.wall_s + answer.setup_s).toFixed(2)} s for ${answer.time_s.length} instants; the wave's force is at most ${((100 * apart) / most).toFixed(1)} % of their peak apart.`);
    };
    return null;
  }
  get("ask")?.addEventListener("click", ask);

  // ---- begin
  data.specimens.forEach((one, k) => {
    const tool = `${+(2e3 * one.wave.tool_radius_m).toPrecision(3)} mm tool, ${one.contact.replaceAll("_", " ")}`;
    get("specimen").add(new Option(`${one.tissue.replaceAll("_", " ")}, ${tool}`, k));
  });
  choose(0);
  if (data.specimens[0].after) { get("state").hidden = false; }
  state.bench.put(0, CENTRE, CENTRE, goal());
  if (calm) state.bench.hands[0].at = goal();
  window.press = { state, data, choose, restart, advance, computed, tick, place, instant, Wave, camera, grid };
  requestAnimationFrame(tick);
})();
