"use strict";
// Draws blocks of layers, tools and lines by WebGL 2, with nothing else. Lengths in mm, z upwards, y away from the viewer.
const Scene = (() => {
  const FLOATS = 7, TURN = 2 * Math.PI, SIDES = 48, BLOCK = 8;

  const VERTEX = `
    in vec3 position; in vec3 normal; in float value;
    uniform mat4 view; out vec3 place; out vec3 facing; out float shown;
    void main() { place = position; facing = normal; shown = value; gl_Position = view * vec4(position, 1.0); }`;
  const VERTEX_SHADED = (shading) => `
    in vec3 position; in vec3 normal; in float value;
    uniform mat4 view; out vec4 paint;
    ${shading}
    void main() {
      vec3 n = dot(normal, eye - position) < 0.0 ? -normal : normal;
      paint = shaded(n, position, value, hue(value)); gl_Position = view * vec4(position, 1.0);
    }`;
  const FRAGMENT_PAINTED = `
    precision mediump float;
    in vec4 paint; out vec4 colour;
    void main() { colour = paint; }`;

  // With a graphics card every point of the picture is shaded; without one, where that is what takes the time, every
  // vertex is, and points take what lies between. mode 0: deflection as a share of the deepest; 1: signed difference, -1 to 1; 2: plain colour.
  const SHADING = `
    uniform vec3 base, eye, low, high; uniform float mode, lines, alpha;
    vec3 deep(float t) {
      vec3 a = vec3(0.93, 0.42, 0.36), b = vec3(0.62, 0.17, 0.48), c = vec3(0.20, 0.07, 0.42);
      return t < 0.38 ? mix(base, a, smoothstep(0.0, 1.0, t / 0.38)) : t < 0.7 ? mix(a, b, (t - 0.38) / 0.32) : mix(b, c, min((t - 0.7) / 0.3, 1.0));
    }
    vec3 hue(float shown) {
      if (mode < 0.5) return deep(clamp(shown, 0.0, 1.0));
      if (mode < 1.5) return mix(vec3(0.93, 0.92, 0.90), shown < 0.0 ? low : high, pow(min(abs(shown), 1.0), 0.75));
      return base;
    }
    vec4 shaded(vec3 facing, vec3 place, float shown, vec3 paint) {
      vec3 n = normalize(facing), light = normalize(vec3(-0.35, -0.55, 0.9)), to = normalize(eye - place);
      float diffuse = max(dot(n, light), 0.0), sky = 0.5 + 0.5 * n.z;
      float gleam = pow(max(dot(n, normalize(light + to)), 0.0), 40.0) * 0.22;
      return vec4((paint * (0.46 + 0.2 * sky + 0.44 * diffuse) + gleam * (mode < 2.5 ? 1.0 : 0.0)) * alpha, alpha);
    }`;

  const FRAGMENT = `
    precision highp float;
    in vec3 place; in vec3 facing; in float shown; out vec4 colour;
    ${SHADING}
    void main() {
      vec3 paint = hue(shown);
      if (mode < 1.5 && lines > 0.0) {
        float step = shown * lines, edge = abs(fract(step - 0.5) - 0.5) / max(fwidth(step), 1e-6);
        float near = smoothstep(0.03, 0.12, abs(shown));
        paint = mix(paint, paint * 0.62, (1.0 - smoothstep(0.4, 1.5, edge)) * near);
      }
      colour = shaded(gl_FrontFacing ? facing : -facing, place, shown, paint);
    }`;

  const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => { const size = Math.hypot(...a); return a.map((part) => part / size); };

  // Looks at a target from an azimuth and an elevation (rad); `aspect` is width over height.
  class Camera {
    constructor() { this.azimuth = -0.42; this.elevation = 0.5; this.zoom = 1; this.target = [0, 0, 0]; this.size = 50; this.field = 0.42; }

    place(aspect) {
      const { azimuth, elevation, target } = this;
      const across = 0.5 * this.size * 1.18, tan = Math.tan(this.field / 2);
      const far = Math.max(across / (tan * aspect), (across * 0.6) / tan) / this.zoom + 0.35 * this.size;
      const back = [Math.sin(azimuth) * Math.cos(elevation), -Math.cos(azimuth) * Math.cos(elevation), Math.sin(elevation)];
      const eye = target.map((part, axis) => part + far * back[axis]);
      const right = unit(cross([0, 0, 1], back)), up = cross(back, right);
      return { eye, back, right, up, tan, aspect, far };
    }

    matrix(aspect) {
      const { eye, back, right, up, tan, far } = this.place(aspect), near = far * 0.1, end = far * 4;
      const x = 1 / (tan * aspect), y = 1 / tan, depth = (end + near) / (near - end), shift = (2 * end * near) / (near - end);
      const rows = [right.map((v) => v * x), up.map((v) => v * y), back.map((v) => v * depth), back.map((v) => -v)];
      const last = [-dot(right, eye) * x, -dot(up, eye) * y, -dot(back, eye) * depth + shift, dot(back, eye)];
      return { eye, matrix: new Float32Array([0, 1, 2].flatMap((axis) => rows.map((row) => row[axis])).concat(last)) };
    }

    // Steps back and aside, no closer than `size` asks for, until points stand between two places of the picture's width
    // (-1 to 1); gives the target and size.
    fit(points, target, size, aspect, left, right) {
      Object.assign(this, { target, size });
      for (let turn = 0; turn < 12; turn++) {
        const at = points.map((point) => this.project(point, aspect)[0]), low = Math.min(...at), high = Math.max(...at), view = this.place(aspect);
        this.size *= Math.max((high - low) / (right - left), size / this.size);
        const aside = (0.5 * (low + high - left - right)) * view.tan * aspect * view.far;
        this.target = this.target.map((part, axis) => part + aside * view.right[axis]);
      }
      return { target: this.target, size: this.size };
    }

    // Where a point is in the picture, -1 to 1 each way.
    project(point, aspect) {
      const { eye, back, right, up, tan } = this.place(aspect), way = subtract(point, eye), ahead = -dot(back, way);
      return [dot(right, way) / (tan * aspect * ahead), dot(up, way) / (tan * ahead)];
    }

    // Where the ray through a point of the picture, -1 to 1 each way, meets the plane z; null behind it.
    hit(across, along, aspect, z) {
      const { eye, back, right, up, tan } = this.place(aspect);
      const way = [0, 1, 2].map((axis) => right[axis] * across * tan * aspect + up[axis] * along * tan - back[axis]);
      const share = (z - eye[2]) / way[2];
      return share > 0 ? [eye[0] + share * way[0], eye[1] + share * way[1]] : null;
    }
  }

  class Mesh {
    constructor(gl, vertices, indices) {
      this.gl = gl; this.data = new Float32Array(vertices * FLOATS); this.count = indices.length;
      this.array = gl.createVertexArray(); this.buffer = gl.createBuffer();
      gl.bindVertexArray(this.array);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
      gl.bufferData(gl.ARRAY_BUFFER, this.data.byteLength, gl.DYNAMIC_DRAW);
      for (const [place, size, from] of [[0, 3, 0], [1, 3, 3], [2, 1, 6]]) {
        gl.enableVertexAttribArray(place);
        gl.vertexAttribPointer(place, size, gl.FLOAT, false, FLOATS * 4, from * 4);
      }
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(indices), gl.STATIC_DRAW);
    }

    // What changed: all, or what stands behind a vertex.
    upload(vertex = 0) {
      this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffer);
      this.gl.bufferSubData(this.gl.ARRAY_BUFFER, 4 * FLOATS * vertex, this.data, FLOATS * vertex);
    }

    draw(from = 0, count = this.count - from) {
      this.gl.bindVertexArray(this.array);
      this.gl.drawElements(this.gl.TRIANGLES, count, this.gl.UNSIGNED_INT, 4 * from);
    }
  }

  // Squares of a P x Q grid, `step` vertices wide, in blocks: a vertex is then shaded once or twice, not six times.
  function squares(P, Q, step) {
    const indices = [], at = (i, j) => Math.min(i, P - 1) * Q + Math.min(j, Q - 1);
    for (let block = 0; block < Q - 1; block += BLOCK * step) for (let i = 0; i < P - 1; i += step) {
      for (let j = block; j < Math.min(block + BLOCK * step, Q - 1); j += step) {
        const [a, b, c, d] = [at(i, j), at(i + step, j), at(i + step, j + step), at(i, j + step)];
        indices.push(a, b, c, a, c, d);
      }
    }
    return indices;
  }

  // One layer: its top face on P x Q vertices and a wall round it down to the face below, of so many bands.
  class Slab {
    constructor(gl, P, Q, BANDS = 8) {
      this.P = P; this.Q = Q; this.BANDS = BANDS;
      const fine = squares(P, Q, 1), rough = squares(P, Q, 2), indices = [...fine, ...rough], at = (i, j) => i * Q + j;
      this.walls = []; this.faces = [{ from: 0, count: fine.length }, { from: fine.length, count: rough.length }];
      let next = P * Q;
      for (const [count, vertex, normal] of [
        [P, (k) => at(k, 0), [0, -1, 0]], [P, (k) => at(k, Q - 1), [0, 1, 0]],
        [Q, (k) => at(0, k), [-1, 0, 0]], [Q, (k) => at(P - 1, k), [1, 0, 0]],
      ]) {
        const wall = { first: next, count, vertex, normal, from: indices.length };
        this.walls.push(wall);
        for (let k = 0; k + 1 < count; k++) for (let band = 0; band < BANDS; band++) {
          const a = next + (BANDS + 1) * k + band, b = a + BANDS + 1;
          indices.push(a, a + 1, b, a + 1, b + 1, b);
        }
        next += (BANDS + 1) * count;
        wall.indices = indices.length - wall.from;
      }
      this.mesh = new Mesh(gl, next, indices);
    }

    // Deflections (m) and values of this face and of the one below, from offsets in shared arrays; heights in mm.
    // A covered face is not drawn, so only its border, where the walls begin, is filled.
    fill(xs, ys, faces, values, own, below, top, bottom, covered = false) {
      const { P, Q, BANDS } = this, data = this.mesh.data;
      this.covered = covered; this.bottom = bottom;
      for (let i = 0; i < P; i++) {
        const left = Math.max(i - 1, 0), right = Math.min(i + 1, P - 1), dx = xs[right] - xs[left];
        for (let j = 0, step = covered && i > 0 && i < P - 1 ? Q - 1 : 1; j < Q; j += step) {
          const near = Math.max(j - 1, 0), far = Math.min(j + 1, Q - 1), dy = ys[far] - ys[near];
          const here = own + i * Q + j;
          const nx = (faces[own + right * Q + j] - faces[own + left * Q + j]) / dx;
          const ny = dy > 0 ? (faces[own + i * Q + far] - faces[own + i * Q + near]) / dy : 0;
          const size = Math.sqrt(nx * nx + ny * ny + 1);
          let to = (i * Q + j) * FLOATS;
          data[to++] = xs[i] * 1e3; data[to++] = ys[j] * 1e3; data[to++] = top - faces[here] * 1e3;
          data[to++] = nx / size; data[to++] = ny / size; data[to++] = 1 / size; data[to] = values[here];
        }
      }
      for (const { first, count, vertex, normal } of this.walls) {
        for (let k = 0; k < count; k++) {
          const from = vertex(k), under = below === null ? -1 : below + from, start = top - faces[own + from] * 1e3;
          const end = bottom - (under < 0 ? 0 : faces[under] * 1e3), shown = values[own + from], last = under < 0 ? 0 : values[under];
          for (let band = 0; band <= BANDS; band++) {
            const share = band / BANDS;
            let to = (first + (BANDS + 1) * k + band) * FLOATS;
            data[to++] = data[from * FLOATS]; data[to++] = data[from * FLOATS + 1]; data[to++] = start + share * (end - start);
            data[to++] = normal[0]; data[to++] = normal[1]; data[to++] = normal[2]; data[to] = shown + share * (last - shown);
          }
        }
      }
      this.mesh.upload(covered ? P * Q : 0);
    }

    // Its top face, unless that is covered, of fewer squares where they are `rough`, and the walls that look at the eye; from
    // below all walls, since there is no underside.
    draw(eye, rough) {
      const { data } = this.mesh, face = this.faces[rough ? 1 : 0];
      if (!this.covered) this.mesh.draw(face.from, face.count);
      for (const { first, normal, from, indices } of this.walls) {
        const place = first * FLOATS, ahead = normal[0] * (eye[0] - data[place]) + normal[1] * (eye[1] - data[place + 1]);
        if (ahead > 0 || eye[2] < this.bottom) this.mesh.draw(from, indices);
      }
    }
  }

  // A cylinder that stands on its lower face.
  class Cylinder {
    constructor(gl) {
      const indices = [];
      for (let k = 0; k < SIDES; k++) {
        const a = 2 * k, b = 2 * ((k + 1) % SIDES);
        indices.push(a, b, b + 1, a, b + 1, a + 1);
      }
      const lid = 2 * SIDES;
      for (let k = 0; k < SIDES; k++) indices.push(lid, lid + 1 + k, lid + 1 + ((k + 1) % SIDES));
      this.mesh = new Mesh(gl, 3 * SIDES + 1, indices);
    }

    fill(x, y, z, radius, height) {
      const data = this.mesh.data;
      const put = (vertex, values) => data.set(values, vertex * FLOATS);
      for (let k = 0; k < SIDES; k++) {
        const c = Math.cos((TURN * k) / SIDES), s = Math.sin((TURN * k) / SIDES);
        put(2 * k, [x + radius * c, y + radius * s, z, c, s, 0, 0]);
        put(2 * k + 1, [x + radius * c, y + radius * s, z + height, c, s, 0, 0]);
        put(2 * SIDES + 1 + k, [x + radius * c, y + radius * s, z + height, 0, 0, 1, 0]);
      }
      put(2 * SIDES, [x, y, z + height, 0, 0, 1, 0]);
      this.mesh.upload();
    }
  }

  // A flat dashed band along x in the plane of a cut.
  class Ribbon {
    constructor(gl, most) {
      const indices = [];
      for (let k = 0; k < most; k++) indices.push(4 * k, 4 * k + 1, 4 * k + 2, 4 * k, 4 * k + 2, 4 * k + 3);
      this.mesh = new Mesh(gl, 4 * most, indices); this.most = most;
    }

    fill(xs, y, heights, half, dash) {
      const data = this.mesh.data.fill(0);
      for (let k = 0, at = 0; k + 1 < xs.length && at < this.most; k++) {
        if (dash && k % 3 === 2) continue;
        const corners = [[xs[k], heights[k] - half], [xs[k + 1], heights[k + 1] - half], [xs[k + 1], heights[k + 1] + half], [xs[k], heights[k] + half]];
        corners.forEach(([x, z], corner) => data.set([x, y, z, 0, -0.4, 0.9, 0], (4 * at + corner) * FLOATS));
        at++;
      }
      this.mesh.upload();
    }
  }

  class Renderer {
    constructor(canvas) {
      const software = (this.software = inSoftware());
      const gl = canvas.getContext("webgl2", { antialias: !software, alpha: !software, premultipliedAlpha: true });
      if (!gl) throw new Error("WebGL 2 is not available");
      this.gl = gl; this.canvas = canvas; this.detail = software ? 0.64 : 1; this.recent = []; this.good = 0; this.patience = 8; this.tried = false; this.rough = false; this.ground = [0, 0, 0, 0];
      new ResizeObserver(() => { this.size = null; }).observe(canvas);
      const program = (this.program = gl.createProgram());
      const texts = software ? [VERTEX_SHADED(SHADING), FRAGMENT_PAINTED] : [VERTEX, FRAGMENT];
      for (const [kind, text] of [[gl.VERTEX_SHADER, texts[0]], [gl.FRAGMENT_SHADER, texts[1]]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, `#version 300 es${text}`);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(program, shader);
      }
      ["position", "normal", "value"].forEach((name, place) => gl.bindAttribLocation(program, place, name));
      gl.linkProgram(program);
      if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
      this.at = Object.fromEntries(["view", "base", "eye", "low", "high", "mode", "lines", "alpha"].map((name) => [name, gl.getUniformLocation(program, name)]));
      gl.useProgram(program);
      gl.enable(gl.DEPTH_TEST);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    }

    resize() {
      this.size ??= { clientWidth: this.canvas.clientWidth, clientHeight: this.canvas.clientHeight };
      const scale = (this.software ? 1 : Math.min(window.devicePixelRatio || 1, 2)) * this.detail, { clientWidth, clientHeight } = this.size;
      const width = Math.max(1, Math.round(clientWidth * scale)), height = Math.max(1, Math.round(clientHeight * scale));
      if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    }

    // Fewer squares of each face, then fewer pixels, where most of thirty frames (ms) come too slowly. More are tried after a
    // while of good ones; where they were too many, the next try waits twice as long.
    pace(frame) {
      this.recent.push(frame);
      if (this.recent.length < 30) return;
      const median = this.recent.sort((a, b) => a - b)[15];
      this.recent = [];
      this.good = median < 17.5 ? this.good + 1 : 0;
      if (median > 19) {
        if (this.tried) this.patience *= 2;
        if (this.software && !this.rough) this.rough = true; else this.detail = Math.max(0.8 * this.detail, this.software ? 0.4 : 0.45);
        this.tried = false;
      } else if (this.good >= this.patience && (this.detail < 1 || this.rough)) {
        if (this.detail < 1) this.detail = Math.min(1.25 * this.detail, 1); else this.rough = false;
        this.tried = true; this.good = 0;
      } else if (this.good > 4) this.tried = false;
    }

    clear() {
      this.gl.viewport(0, 0, this.canvas.width, this.canvas.height);
      this.gl.clearColor(...this.ground);
      this.gl.clear(this.gl.COLOR_BUFFER_BIT | this.gl.DEPTH_BUFFER_BIT);
    }

    // Draws into the part of the canvas between two shares of its width.
    begin(camera, from, to, low, high) {
      const { gl, at } = this, width = this.canvas.width, left = Math.round(from * width), wide = Math.round(to * width) - left;
      gl.viewport(left, 0, wide, this.canvas.height);
      const { eye, matrix } = camera.matrix(wide / this.canvas.height);
      this.eye = eye;
      gl.uniformMatrix4fv(at.view, false, matrix);
      gl.uniform3fv(at.eye, eye); gl.uniform3fv(at.low, low); gl.uniform3fv(at.high, high);
    }

    draw(mesh, base, { mode = 2, lines = 0, alpha = 1 } = {}) {
      const { gl, at } = this;
      gl.uniform3fv(at.base, base);
      gl.uniform1f(at.mode, mode); gl.uniform1f(at.lines, lines); gl.uniform1f(at.alpha, alpha);
      if (alpha < 1) { gl.enable(gl.BLEND); gl.depthMask(false); }
      if (mesh instanceof Slab) mesh.draw(this.eye, this.rough); else mesh.draw();
      if (alpha < 1) { gl.disable(gl.BLEND); gl.depthMask(true); }
    }
  }

  // Whether pictures are made by the processor, where smooth edges cost too much.
  function inSoftware() {
    const gl = document.createElement("canvas").getContext("webgl2"), told = gl?.getExtension("WEBGL_debug_renderer_info");
    const name = told ? String(gl.getParameter(told.UNMASKED_RENDERER_WEBGL)) : "";
    gl?.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|software/i.test(name);
  }

  const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);

  return { Camera, Slab, Cylinder, Ribbon, Renderer, rgb };
})();
