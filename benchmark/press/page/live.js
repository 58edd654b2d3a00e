"use strict";
// A running capture on the page (served with --live only): its camera and figures, its force beside the wave's, and the
// tool of the page led by the tool of the bench.
(() => {
  const { state } = press, KEPT = 12, CENTRE = 24.5e-3, get = (id) => document.getElementById(id);
  const film = get("film"), picture = film.getContext("2d");
  const live = (state.live = { force: [], depth: [], shift: null, trial: "", newest: 0, pictures: 0, news: null, drawing: false });
  state.demo = false;  // on this page the bench alone presses
  state.bench.lift(0);
  const shown = (number) => (Math.abs(number) < 0.005 ? 0 : number).toFixed(2);
  const shade = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

  // Where in the list of [time, value] an instant falls, interpolated; null outside.
  function at(rows, time) {
    if (!rows.length || time < rows[0][0]) return null;
    let k = rows.length - 1;
    while (rows[k][0] > time) k--;
    const [from, value] = rows[k], next = rows[k + 1];
    return next ? value + ((time - from) / (next[0] - from)) * (next[1] - value) : value;
  }

  // The page shows the bench a moment late, so that what arrives in bursts moves evenly.
  function arrived(rows, more) {
    rows.push(...more);
    while (rows.length && rows[0][0] < live.newest - KEPT) rows.shift();
  }

  function heard(news) {
    live.news = news;
    if (news.error) return say(news.error, "", true);
    if (news.waiting) return waiting(news);
    if (news.trial !== live.trial) {
      for (const one of state.traces) Object.assign(one, { time: press.instant(one), led: null });
      Object.assign(live, { trial: news.trial, force: [], depth: [], shift: null, newest: 0 });
    }
    const last = news.force.at(-1);
    if (last) {
      live.newest = last[0];
      const lag = state.bench.time - live.newest;
      live.shift = live.shift === null || Math.abs(lag - live.shift) > 1 ? lag : Math.max(lag, live.shift - 0.02 * (live.shift - lag));
      get("live-force").textContent = shown(last[1]);
    }
    arrived(live.force, news.force);
    arrived(live.depth, news.depth);
    if (news.depth.length) get("live-depth").textContent = shown(1e3 * news.depth.at(-1)[1]);
    if (news.force_lost !== undefined) get("live-lost").textContent = news.force_lost;
    if (news.camera) seen(news.camera);
    const silent = news.silent_s ? "nothing new: the recording has stopped, or nothing reaches its file" : "", since = silent && `, silent for ${news.silent_s.toFixed(0)} s`;
    const doing = news.faults.length ? news.faults.at(-1) : news.ended ? "ended" : silent || news.doing || "begins";
    return say(title(news), doing, news.faults.length || silent, `${live.newest.toFixed(1)} s${since},`);
  }

  const title = ({ trial, synthetic }) => `${trial.replace(/\.mcap$/, "")}${synthetic ? " (simulated)" : ""}`;

  // Between two trials: how the last one ended stays.
  function waiting({ waiting: where, last }) {
    get("live-rate").textContent = "–";
    if (!last) return say("Waiting for a capture", where);
    const end = last.faults.length ? `ended (${last.faults.at(-1)})` : "ended";
    return say(title(last), `${last.seconds.toFixed(1)} s, ${end}. Waiting for the next trial in ${where}`, last.faults.length);
  }

  // The clock stands apart: what a trial does is told to who listens when it changes, not ten times a second.
  function say(head, rest, bad, clock = "") {
    get("live-trial").textContent = head;
    get("live-time").textContent = clock;
    if (get("live-doing").textContent !== rest) get("live-doing").textContent = rest;
    get("live").classList.toggle("fault", Boolean(bad));
  }

  async function seen(camera) {
    get("live-rate").textContent = camera.rate.toFixed(1);
    get("live-dropped").textContent = camera.dropped;
    get("live-markers").textContent = camera.markers.length ? `${camera.markers.length} markers` : camera.why;
    if (live.drawing) return;
    live.drawing = true;
    try {
      const bytes = Uint8Array.from(atob(camera.picture), (letter) => letter.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: `image/${camera.format}` }));
      if (film.width !== bitmap.width || film.height !== bitmap.height) Object.assign(film, { width: bitmap.width, height: bitmap.height });
      picture.drawImage(bitmap, 0, 0);
      bitmap.close();
      Object.assign(picture, { strokeStyle: shade("wave"), lineWidth: film.width / 320 });
      for (const [x, y] of camera.markers) {
        picture.beginPath();
        picture.arc(x, y, camera.radius + 1.5, 0, 7);
        picture.stroke();
      }
      live.pictures++;
    } catch (error) {
      get("live-markers").textContent = `the picture cannot be shown (${error.message})`;
    }
    live.drawing = false;
  }

  // Measured force in the page's own time, for the trace.
  live.trace = () => (live.shift === null ? [] : live.force.map(([time, force]) => [time + live.shift, force]).filter(([time]) => time <= state.bench.time));

  // Once a frame: the tool goes where the bench's tool was a moment ago.
  live.lead = () => {
    live.led = get("led").checked && live.shift !== null ? Math.min(state.bench.time - live.shift, live.newest) : null;  // the bench's time; null where the tool is loose
    if (live.led === null) return;
    const depth = at(live.depth, live.led), hand = state.bench.hands[0];
    state.demo = false;
    if (depth === null || depth <= 0) { if (hand.on) state.bench.lift(0); return; }
    state.bench.put(0, CENTRE, CENTRE, depth);
    hand.at = depth;
  };

  const line = new WebSocket(`ws://${location.host}${location.pathname}live`);
  line.onmessage = (event) => heard(JSON.parse(event.data));
  line.onclose = () => say("The watcher has ended", "the recording goes on without it");
})();
