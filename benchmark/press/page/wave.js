"use strict";
// The wave model under interactive tools: what wavemodel.control computes, in plain JavaScript, from tables made by it.
// SI units; depths, deflections and forces are positive into the tissue. Nothing here draws or listens.
const Wave = (() => {
  const SWEEPS = 200, CLOSE = 1e-12, GONE = 1e-9, ROUNDING = 1e-9;

  const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
  const singles = (text) => new Float32Array(bytesOf(text));
  const doubles = (text) => new Float64Array(bytesOf(text));

  // One tool on one tissue: B fields over R radii for L layers, their weights and the elastic force at N even depths.
  class RadialBody {
    constructor(table) {
      Object.assign(this, {
        layers: table.layers, radii: table.radii, count: table.fields, reach: table.reach_m, deepest: table.deepest_m,
        toolRadius: table.tool_radius_m, fields: singles(table.field), weights: doubles(table.weight),
        force: doubles(table.force_N), surface: table.surface ? doubles(table.surface) : null,
      });
      this.nodes = this.force.length;
      this.profile = new Float64Array(this.layers * this.radii);
      this.drawn = NaN;
    }

    elastic(depth) {
      const place = (depth / this.deepest) * (this.nodes - 1), low = this._cell(place);
      return this.force[low] + (place - low) * (this.force[low + 1] - this.force[low]);
    }

    depth(elastic) {
      let low = 0, high = this.nodes - 1;
      while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (this.force[middle] <= elastic) low = middle; else high = middle;
      }
      const share = (elastic - this.force[low]) / (this.force[low + 1] - this.force[low]);
      return ((low + share) * this.deepest) / (this.nodes - 1);
    }

    // Depth that one newton on one tool adds under another so far away, m/N; nought where patches just add up.
    between(distance) {
      if (!this.surface || distance >= this.reach) return 0;
      const place = (distance / this.reach) * (this.surface.length - 1), low = Math.floor(place);
      return this.surface[low] + (place - low) * (this.surface[Math.min(low + 1, this.surface.length - 1)] - this.surface[low]);
    }

    returning(elastic, share) { return this.elastic((1 - share) * this.depth(elastic)); }
    returnTime() { return null; }
    reaction(elastic) { return elastic; }

    // Adds the patch of a tool at (x, y) to `out` (L x P x Q), at vertices xs (P) by ys (Q).
    add(elastic, x, y, xs, ys, out) {
      if (elastic) this.addAtDepth(this.depth(elastic), x, y, xs, ys, out);
    }

    addAtDepth(depth, x, y, xs, ys, out) {
      if (!depth) return;
      this._combine(depth);
      const { radii, layers, profile, reach } = this, scale = (radii - 1) / reach;
      const columns = ys.length, size = xs.length * columns, last = radii - 1;
      for (let i = 0; i < xs.length; i++) {
        const dx = xs[i] - x;
        if (Math.abs(dx) > reach) continue;
        for (let j = 0; j < columns; j++) {
          const dy = ys[j] - y, place = Math.sqrt(dx * dx + dy * dy) * scale;
          if (place >= last) continue;
          const low = place | 0, ahead = place - low;
          for (let layer = 0, at = low, to = i * columns + j; layer < layers; layer++, at += radii, to += size) {
            out[to] += profile[at] + ahead * (profile[at + 1] - profile[at]);
          }
        }
      }
    }

    // Deflection of each layer's top face at a distance from a tool this deep, m.
    at(depth, distance, out) {
      this._combine(depth);
      const place = Math.min((distance / this.reach) * (this.radii - 1), this.radii - 1), low = Math.min(Math.floor(place), this.radii - 2);
      for (let layer = 0; layer < this.layers; layer++) {
        const at = layer * this.radii + low;
        out[layer] = this.profile[at] + (place - low) * (this.profile[at + 1] - this.profile[at]);
      }
      return out;
    }

    _cell(place) { return Math.min(Math.max(Math.floor(place), 0), this.nodes - 2); }

    _combine(depth) {
      if (depth === this.drawn) return;
      const { count, profile, fields, weights } = this, size = profile.length;
      const place = (depth / this.deepest) * (this.nodes - 1), low = this._cell(place), ahead = place - low;
      profile.fill(0);
      for (let b = 0; b < count; b++) {
        const here = weights[low * count + b], weight = here + ahead * (weights[(low + 1) * count + b] - here);
        for (let k = 0, from = b * size; k < size; k++) profile[k] += weight * fields[from + k];
      }
      this.drawn = depth;
    }
  }

  // The membrane of the article, eqs. (7) and (8): its "elastic force" is the cosine of the membrane's time.
  class PublishedBody {
    constructor(given) {
      Object.assign(this, {
        layers: 1, toolRadius: 0, side: given.side_m, reach: 0.5 * given.side_m, deepest: given.deepest_m,
        coefficient: given.coefficient_m, frequency: given.frequency_per_s,
      });
    }

    elastic(depth) { return Math.cos(Math.acos(depth / this.deepest)); }
    depth(elastic) { return elastic * this.deepest; }
    reaction() { return NaN; }
    between() { return 0; }
    returning(elastic, share) {
      const angle = Math.acos(elastic);
      return Math.cos(angle + share * (0.5 * Math.PI - angle));
    }
    returnTime(elastic) { return (0.5 * Math.PI - Math.acos(elastic)) / this.frequency; }

    add(elastic, x, y, xs, ys, out) {
      const scale = Math.PI / this.side, edge = this.reach * (1 + 1e-9);
      for (let i = 0; i < xs.length; i++) {
        const dx = xs[i] - x;
        if (Math.abs(dx) > edge) continue;
        const along = this.coefficient * elastic * Math.cos(scale * dx);
        for (let j = 0; j < ys.length; j++) {
          const dy = ys[j] - y;
          if (Math.abs(dy) <= edge) out[i * ys.length + j] += along * Math.cos(scale * dy);
        }
      }
    }
  }

  const product = (a, b, n) => {
    const out = new Float64Array(n * n);
    for (let i = 0; i < n; i++) for (let k = 0; k < n; k++) for (let j = 0; j < n; j++) out[i * n + j] += a[i * n + k] * b[k * n + j];
    return out;
  };

  // Exponential of an (n, n) matrix: Taylor's series of a fraction, squared again.
  function exponential(matrix, n) {
    let norm = 0;
    for (let i = 0; i < n; i++) {
      let row = 0;
      for (let j = 0; j < n; j++) row += Math.abs(matrix[i * n + j]);
      norm = Math.max(norm, row);
    }
    const halvings = Math.max(0, Math.ceil(Math.log2(Math.max(norm, 1e-300))) + 2), small = matrix.map((value) => value / 2 ** halvings);
    let out = new Float64Array(n * n), term = new Float64Array(n * n);
    for (let i = 0; i < n; i++) out[i * n + i] = term[i * n + i] = 1;
    for (let k = 1; k <= 16; k++) {
      term = product(term, small, n).map((value) => value / k);
      out = out.map((value, at) => value + term[at]);
    }
    for (let k = 0; k < halvings; k++) out = product(out, out, n);
    return out;
  }

  // Memory of each contact while it is held, and how it comes back when the tool is gone (ContactRelaxation).
  class ContactRelaxation {
    constructor(contacts, strength, time, retardation) {
      this.strength = strength; this.rate = time.map((tau) => 1 / tau); this.eta = retardation; this.dt = 0;
      this.state = Array.from({ length: contacts }, () => new Float64Array(strength.length + 1));
    }

    held(contact, elastic, dt) {
      this._prepare(dt);
      const state = this.state[contact], count = this.strength.length, before = state[count];
      let force = elastic;
      for (let j = 0; j < count; j++) {
        const [keep, first, last] = this.steps[j];
        state[j] = keep * state[j] + first * before + last * elastic;
        force -= state[j];
      }
      state[count] = elastic;
      return force + (this.eta * (elastic - before)) / dt;
    }

    // The elastic force at which the held contact answers with a force at the end of a frame.
    elasticFor(contact, force, dt) {
      this._prepare(dt);
      const state = this.state[contact], count = this.strength.length, before = state[count];
      let left = force + (this.eta * before) / dt, share = 1 + this.eta / dt;
      for (let j = 0; j < count; j++) {
        const [keep, first, last] = this.steps[j];
        left += keep * state[j] + first * before;
        share -= last;
      }
      return left / share;
    }

    free(contact, dt) {
      this._prepare(dt);
      this.loose ??= this._released(dt);
      const state = this.state[contact], n = state.length, old = state.slice();
      for (let i = 0; i < n; i++) {
        state[i] = 0;
        for (let j = 0; j < n; j++) state[i] += this.loose[i * n + j] * old[j];
      }
      return state[n - 1];
    }

    fade(contact, share) { this.state[contact].forEach((part, k, all) => { all[k] = share * part; }); }

    forget(contact) { this.state[contact].fill(0); }

    _prepare(dt) {
      if (dt === this.dt) return;
      this.steps = this.rate.map((rate, j) => {
        const ratio = rate * dt, keep = Math.exp(-ratio), mean = -Math.expm1(-ratio) / ratio;
        return [keep, this.strength[j] * (mean - keep), this.strength[j] * (1 - mean)];
      });
      this.loose = null;
      this.dt = dt;
    }

    _released(dt) {
      const count = this.strength.length, n = count + 1, whole = new Float64Array(n * n);
      if (this.eta) {
        for (let j = 0; j < count; j++) {
          whole[j * n + j] = -this.rate[j] * dt;
          whole[j * n + count] = this.rate[j] * this.strength[j] * dt;
          whole[count * n + j] = dt / this.eta;
        }
        whole[count * n + count] = -dt / this.eta;
        return exponential(whole, n);
      }
      if (!count) return whole;
      const lags = new Float64Array(count * count);
      for (let i = 0; i < count; i++) {
        for (let j = 0; j < count; j++) lags[i * count + j] = (this.rate[i] * this.strength[i] - (i === j ? this.rate[i] : 0)) * dt;
      }
      const kept = exponential(lags, count);
      for (let i = 0; i < count; i++) {
        for (let j = 0; j < count; j++) {
          whole[i * n + j] = kept[i * count + j];
          whole[count * n + j] += kept[i * count + j];
        }
      }
      return whole;
    }
  }

  // A tissue under several tools: touch, release, frame by frame (InteractiveTissue).
  class InteractiveTissue {
    constructor(body, grid, contacts, memory = {}) {
      this.body = body; this.grid = grid;
      this.force = new Float64Array(contacts);
      this.tools = Array.from({ length: contacts }, () => ({ x: 0, y: 0, depth: 0, phase: "idle", elastic: 0, start: 0, share: 0, steps: null }));
      this.relaxation = new ContactRelaxation(contacts, memory.strength ?? [], memory.time_s ?? [], memory.retardation_s ?? 0);
      this.faces = new Float64Array(body.layers * grid.xs.length * grid.ys.length);
    }

    // Null, or why the tool cannot be there; a refused touch changes nothing.
    touch(contact, x, y, depth) {
      const { width, height } = this.grid;
      if (!(x >= 0 && x <= width && y >= 0 && y <= height)) return "outside the tissue";
      if (!(depth >= 0 && depth <= this.body.deepest)) return "deeper than the model goes";
      const near = this.tools.some((other, index) => index !== contact && other.phase === "pressed"
        && Math.hypot(x - other.x, y - other.y) < 2 * this.body.toolRadius * (1 - ROUNDING));
      if (near) return "closer than two tool radii to the other tool";
      const tool = this.tools[contact];
      if (tool.phase === "returning" && Math.hypot(x - tool.x, y - tool.y) > this.body.toolRadius) this._forget(contact, tool);
      if (tool.phase !== "pressed") tool.rested = tool.phase === "idle";
      Object.assign(tool, { x, y, depth, phase: "pressed" });
      return null;
    }

    // The depth, within what the body answers, at which one tool alone feels a force at the end of a frame.
    depthFor(contact, force, dt) {
      const elastic = Math.max(this.relaxation.elasticFor(contact, force, dt), 0);
      return Math.min(this.body.depth(elastic), this.body.deepest);
    }

    release(contact, steps = null) {
      const tool = this.tools[contact];
      if (tool.phase === "pressed") Object.assign(tool, { phase: "returning", start: tool.elastic, share: 0, steps });
    }

    frame(dt) {
      this.advance(dt);
      return this.draw(this.faces.fill(0), this.grid.xs, this.grid.ys);
    }

    // Forces and states one frame on, without the faces.
    advance(dt) {
      this.tools.forEach((tool, index) => { if (tool.phase === "returning") this._return(index, tool, dt); });
      this._press(dt);
      this.tools.forEach((tool, index) => {
        this.force[index] = tool.phase === "pressed" ? this.body.reaction(Math.max(this.relaxation.held(index, tool.elastic, dt), 0)) : 0;
      });
    }

    // Adds all patches to `out`, at any vertices.
    draw(out, xs, ys) {
      for (const tool of this.tools) if (tool.elastic) this.body.add(tool.elastic, tool.x, tool.y, xs, ys, out);
      return out;
    }

    _return(index, tool, dt) {
      const alone = this.body.returnTime(tool.start);
      let done;
      if (tool.steps === null && alone === null) {
        tool.elastic = this.relaxation.free(index, dt);
        done = Math.abs(tool.elastic) <= GONE * Math.abs(tool.start);
      } else {
        tool.share += tool.steps === null ? dt / Math.max(alone ?? 0, 1e-300) : 1 / tool.steps;
        done = tool.share >= 1 - 1e-9;
        const before = tool.elastic;
        tool.elastic = done ? 0 : this.body.returning(tool.start, tool.share);
        this.relaxation.fade(index, before ? tool.elastic / before : 0);
      }
      if (done) this._forget(index, tool);
    }

    _forget(index, tool) {
      tool.elastic = 0; tool.phase = "idle";
      this.relaxation.forget(index);
    }

    // Elastic forces that bring each pressed tool to its depth under the forces of all; no tool pulls.
    _press(dt) {
      const busy = this.tools.filter((tool) => tool.phase !== "idle").length;
      const before = this.tools.map((tool) => tool.elastic);
      for (let sweep = 0, scale = 0; sweep < (busy > 1 ? SWEEPS : 1); sweep++) {
        let change = 0;
        for (const [index, tool] of this.tools.entries()) {
          if (tool.phase !== "pressed") continue;
          let found = this.body.elastic(Math.max(tool.depth - this._sunk(tool), 0));
          if (found < before[index]) found = Math.max(found, this.relaxation.elasticFor(index, 0, dt));
          change = Math.max(change, Math.abs(found - tool.elastic));
          tool.elastic = found;
          scale = Math.max(scale, Math.abs(found));
        }
        if (change <= CLOSE * scale) break;
      }
    }

    _sunk(tool) {
      let sum = 0;
      for (const other of this.tools) {
        if (other !== tool && other.elastic) sum += other.elastic * this.body.between(Math.hypot(tool.x - other.x, tool.y - other.y));
      }
      return sum;
    }
  }

  function grid(width, height, spacing) {
    const line = (side) => Float64Array.from({ length: Math.floor(side / spacing + 1e-9) + 1 }, (_, k) => k * spacing);
    return { width, height, spacing, xs: line(width), ys: line(height) };
  }

  return { RadialBody, PublishedBody, ContactRelaxation, InteractiveTissue, grid };
})();
if (typeof module !== "undefined") module.exports = Wave;
