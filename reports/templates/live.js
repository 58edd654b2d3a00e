"use strict";
// Puts a plot to zoom or a body to turn in the place of each picture that has data for one. Whatever is missing for it
// (decompression, 3-D drawing), the picture stays.
(() => {
  const TURN = 1.5 * Math.PI, STEPS = 54, ARROW = 0.12, FITS = 470;
  const BUTTONS = {
    plot: ["zoom2d", "pan2d", "resetScale2d", "toImage"],
    body: ["orbitRotation", "zoom3d", "pan3d", "resetCameraDefault3d", "toImage"],
  };
  const panels = [...document.querySelectorAll(".panel[data-live]")];
  const store = document.getElementById("plotly");
  if (!panels.length || !store || !window.DecompressionStream) return;

  let loading = null;
  const library = () => (loading ??= unpack());
  async function unpack() {
    const bytes = Uint8Array.from(atob(store.textContent), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    const script = document.createElement("script");
    script.textContent = await new Response(stream).text();
    document.head.append(script);
    return window.Plotly;
  }

  const shade = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  const mixed = (first, second, share) => {
    const part = (colour, at) => parseInt(colour.slice(at, at + 2), 16);
    return "rgb(" + [1, 3, 5].map((at) => Math.round((1 - share) * part(first, at) + share * part(second, at))) + ")";
  };
  const axis = (label) => ({
    title: { text: label, font: { color: shade("muted") }, standoff: 8 }, color: shade("muted"),
    gridcolor: shade("grid"), zerolinecolor: shade("muted"), automargin: true,
  });
  const common = (title) => ({
    title: { text: title, x: 0, xref: "container", y: 1, yref: "container", yanchor: "top", pad: { t: 8 }, font: { size: 14 } },
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: getComputedStyle(document.body).fontFamily, size: 12, color: shade("ink") },
    hoverlabel: { bgcolor: shade("raised"), bordercolor: shade("muted"), font: { color: shade("ink") } },
    modebar: { bgcolor: "rgba(0,0,0,0)", color: shade("muted"), activecolor: shade("link"), orientation: "h" },
    margin: { l: 8, r: 8, t: 62, b: 8 },
    legend: { orientation: "h", x: 0, y: 1, yanchor: "bottom" },
  });

  function plot(data) {
    const layout = { ...common(data.title), hovermode: "x unified", xaxis: axis(data.x_label), shapes: [], annotations: [] };
    const traces = [], count = data.axes.length;
    data.axes.forEach((part, place) => {
      const id = place ? place + 1 : "", top = place ? 0.3 : 1, bottom = place || count === 1 ? 0 : 0.38;
      layout["yaxis" + id] = {
        ...axis(part.label), domain: [bottom, top], autorange: part.downwards ? "reversed" : true,
      };
      // A narrow line lies on a wide one that it would be covered by; the legend keeps their order.
      for (const line of [...part.lines].sort((a, b) => b.width - a.width)) {
        traces.push({
          type: "scatter", mode: "lines", name: line.name, x: line.x, y: line.y, yaxis: "y" + id,
          line: { color: shade(line.colour), dash: line.dash, width: line.width },
          legendrank: part.lines.indexOf(line) + 1, showlegend: place === 0, hovertemplate: "%{y:.5g}",
        });
      }
    });
    layout.xaxis.anchor = "y" + (count > 1 ? count : "");
    for (const [x, text] of data.marks) {
      const line = { color: shade("muted"), width: 1, dash: "dot" };
      layout.shapes.push({ type: "line", x0: x, x1: x, y0: 0, y1: 1, yref: "paper", line });
      layout.annotations.push({
        x, y: 0, yref: "paper", text, showarrow: false, xanchor: "left", yanchor: "bottom",
        font: { color: shade("muted") },
      });
    }
    return [traces, layout];
  }

  const angles = Array.from({ length: STEPS + 1 }, (_, k) => TURN * k / STEPS);
  const circle = (r, z) => ({
    x: angles.map((a) => r * Math.cos(a)), y: angles.map((a) => r * Math.sin(a)), z: angles.map(() => z),
  });
  // The way along the wall: out from the axis, round the rim, back to the axis; [index of radius, angle].
  const way = (count) => [
    ...Array.from({ length: count }, (_, k) => [k, 0]), ...angles.map((a) => [count - 1, a]),
    ...Array.from({ length: count }, (_, k) => [count - 1 - k, TURN]),
  ];

  function body(data, width) {
    const radius = data.radius, route = way(radius.length), traces = [];
    const still = { showscale: false, hoverinfo: "skip", lighting: { ambient: 0.75, diffuse: 0.35, specular: 0 } };
    data.faces.forEach((face, place) => {
      const turned = radius.map((r, k) => circle(r, face.height[k]));
      const grid = (name) => turned.map((each) => each[name]);
      const group = { legendgroup: face.name, name: face.name };
      traces.push({
        ...still, ...group, type: "surface", x: grid("x"), y: grid("y"), z: grid("z"),
        surfacecolor: radius.map((_, k) => angles.map(() => face.value[k])), cmin: 0, cmax: data.limit,
        colorscale: "YlGnBu", reversescale: true, showlegend: face.below === null, showscale: place === 0,
        hoverinfo: "all", hovertemplate: data.value_label + ": %{surfacecolor:.4g}",
        colorbar: {
          title: { text: data.value_label, side: "right" }, orientation: "h", thickness: 10, len: 0.7, y: 0,
          yanchor: "top", outlinewidth: 0,
        },
      });
      if (face.below === null) return;
      const colour = mixed(shade("tissue"), shade("paper"), 0.15 + 0.6 * place / data.faces.length);
      const rows = [face.height, face.below].map((height) => route.map(([k]) => height[k]));
      const along = (turn) => rows.map(() => route.map(([k, a]) => radius[k] * turn(a)));
      traces.push({
        ...still, ...group, type: "surface", x: along(Math.cos), y: along(Math.sin), z: rows, showlegend: true,
        colorscale: [[0, colour], [1, colour]],
      });
    });
    const at = radius.findLastIndex((r) => r <= data.ring * (1 + 1e-9));
    traces.push({
      ...circle(radius[at], data.faces[0].height[at] + 0.02 * data.ring), type: "scatter3d", mode: "lines",
      name: "tool edge", line: { color: shade("tool"), width: 5 }, hoverinfo: "skip",
    });
    const side = (label) => ({ ...axis(label), nticks: 5, showbackground: false });
    // The camera sees as much of the height wherever it is; in a narrow place it stands back for the titles at the sides.
    const back = Math.max(1, FITS / width);
    const camera = { eye: { x: 1.35 * back, y: -1.6 * back, z: 1.07 * back }, center: { x: -0.06, y: -0.05, z: -0.12 } };
    const scene = {
      aspectmode: "data", camera, xaxis: side("x (mm)"), yaxis: side("y (mm)"),
      zaxis: { ...side("z (mm)"), nticks: 4 },
    };
    return [traces, { ...common(data.title), scene, margin: { l: 0, r: 0, t: 84, b: 34 } }];
  }

  const canDraw3d = () => {
    const context = document.createElement("canvas").getContext("webgl");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return Boolean(context);
  };

  // The arrow keys turn a body, + and - bring it nearer and move it away.
  function turn(event, place, Plotly) {
    const { x, y, z } = place._fullLayout.scene._scene.getCamera().eye;
    let length = Math.hypot(x, y, z), round = Math.atan2(y, x), up = Math.asin(z / length);
    const moves = {
      ArrowLeft: () => (round -= ARROW), ArrowRight: () => (round += ARROW),
      ArrowUp: () => (up = Math.min(up + ARROW, 1.5)), ArrowDown: () => (up = Math.max(up - ARROW, -1.5)),
      "+": () => (length /= 1.1), "-": () => (length *= 1.1),
    };
    if (!(event.key in moves)) return;
    event.preventDefault();
    moves[event.key]();
    const flat = length * Math.cos(up);
    const eye = { x: flat * Math.cos(round), y: flat * Math.sin(round), z: length * Math.sin(up) };
    Plotly.relayout(place, { "scene.camera.eye": eye });
  }

  function swap(panel, place, kind) {
    const button = document.createElement("button"), back = kind === "body" ? "Turn in 3-D" : "Zoom";
    const say = () => (button.textContent = panel.classList.contains("alive") ? "Show the drawing" : back);
    button.type = "button";
    button.className = "swap";
    button.addEventListener("click", () => {
      panel.classList.toggle("alive");
      say();
      if (panel.classList.contains("alive")) window.Plotly.Plots.resize(place);
    });
    panel.append(button);
    say();
  }

  async function enliven(panel) {
    const data = JSON.parse(panel.querySelector("script").textContent);
    if (data.kind === "body" && !canDraw3d()) return;
    const Plotly = await library(), build = data.kind === "body" ? body : plot;
    const drawing = panel.querySelector(".drawing"), size = drawing.getBoundingClientRect();
    const place = document.createElement("div");
    place.className = "live";
    place.style.height = Math.max(size.height, data.kind === "body" ? 400 : 270) + "px";
    place.setAttribute("role", "group");
    place.setAttribute("aria-label", drawing.querySelector("desc")?.textContent ?? "");
    drawing.after(place);
    panel.classList.add("alive");
    const settings = {
      responsive: true, displaylogo: false, scrollZoom: false, displayModeBar: true, modeBarButtons: [BUTTONS[data.kind]],
    };
    await Plotly.newPlot(place, ...build(data, place.clientWidth), settings);
    if (data.kind === "body") {
      place.tabIndex = 0;
      place.addEventListener("keydown", (event) => turn(event, place, Plotly));
    }
    const press = () => place.querySelectorAll(".modebar-btn[data-attr$=dragmode]").forEach(
      (each) => each.setAttribute("aria-pressed", each.classList.contains("active")));
    place.on("plotly_afterplot", press);
    place.on("plotly_relayout", press);
    press();
    const theme = matchMedia("(prefers-color-scheme: dark)");
    theme.addEventListener("change", () => Plotly.react(place, ...build(data, place.clientWidth), settings));
    swap(panel, place, data.kind);
  }

  const near = new IntersectionObserver((seen) => {
    for (const { isIntersecting, target } of seen) {
      if (!isIntersecting) continue;
      near.unobserve(target);
      enliven(target);
    }
  }, { rootMargin: "400px" });
  panels.forEach((panel) => near.observe(panel));
})();
