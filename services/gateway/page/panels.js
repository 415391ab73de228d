// The panels around the picture: status, layers, health, details of a track, warnings.
import { LAYERS } from "./options.js";
import { CLASSES, THEMES, css } from "./theme.js";

const $ = (id) => document.getElementById(id);

export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name.startsWith("--")) node.style.setProperty(name, value);
    else node.setAttribute(name, value);
  }
  node.append(...children);
  return node;
}

export function buildLayers(options, changed) {
  const rows = Object.entries(LAYERS).map(([name, [title]]) => {
    const box = element("input", { type: "checkbox", onchange: () => set(box.checked ? Number(slider.value) || 1 : 0) });
    const slider = element("input", { type: "range", min: 0, max: 1, step: 0.05, "aria-label": `${title}: opacity`, oninput: () => set(Number(slider.value)) });
    const set = (opacity) => {
      options.layers[name] = opacity;
      show();
      changed();
    };
    const show = () => {
      box.checked = options.layers[name] > 0;
      if (box.checked) slider.value = options.layers[name];
    };
    slider.value = options.layers[name] || LAYERS[name][1] || 1;
    show();
    return element("label", { "data-layer": name }, box, title, slider);
  });
  $("layers").replaceChildren(element("h2", {}, "Layers"), ...rows);
}

export function showLegend(theme) {
  const colors = THEMES[theme];
  const entry = (name, color, shape = "") => element("span", { "--color": css(colors[color]) }, element("i", { class: shape }), name);
  $("legend").replaceChildren(
    entry("car", "car"), entry("truck or bus", "truck"), entry("bicycle", "bicycle"), entry("pedestrian", "pedestrian"), entry("unknown class", "other"),
    entry("stationary", "stationary", "point"), entry("moving", "moving", "point"), entry("undecided", "unknown", "point"), entry("way", "way", "line"),
  );
}

/** state: "connecting", "waiting", "live", "stale" or "lost". */
export function showStatus(state, world, now) {
  const age = world.age(now);
  const words = { connecting: "connecting", waiting: "waiting for scans", live: "live", stale: `stale for ${Math.floor(age)} s`, lost: "disconnected" };
  $("link").dataset.state = state;
  $("link").lastElementChild.textContent = words[state];
  const isAlive = state === "live";
  $("speed").textContent = isAlive ? Math.round(Math.abs(world.pose.speed_mps) * 3.6) : "–";
  $("rate").textContent = isAlive ? Math.round(world.rate) : "–";
  $("count").textContent = isAlive ? world.confirmedCount : "–";
  $("way").textContent = world.way.length ? Math.round(world.drivenLength).toLocaleString("en") : "–";
  document.body.classList.toggle("stale", state === "stale" || state === "lost");
  const banners = {
    lost: ["Disconnected", "trying to reconnect"],
    stale: [`No scan for ${Math.floor(age)} s`, "the picture shows the last one"],
    waiting: ["Waiting for the first scan", "connected to the gateway"],
    connecting: ["Connecting", location.host],
  };
  const banner = banners[state];
  $("banner").hidden = !banner || (state === "stale" && age < 3);
  if (banner) [$("banner").firstElementChild.textContent, $("banner").lastElementChild.textContent] = banner;
}

export function showHealth(health) {
  const warnings = health?.warnings ?? [];
  $("warnings").replaceChildren(...warnings.slice(0, 4).map((text) => element("p", {}, text)));
  if ($("health").hidden || !health) return;
  const services = health.services.map((service) => {
    const latencies = (service.latencies ?? []).filter((latency) => latency.calls > 0).slice(0, 3);
    return element("div", { class: "service" },
      element("header", {}, element("i", { class: "dot", "data-state": service.state }), element("b", {}, service.service),
        service.instance === "main" ? "" : service.instance, element("span", {}, service.state)),
      ...(service.explanation ? [element("p", { class: "trouble" }, service.explanation)] : []),
      ...latencies.map((l) => element("p", {}, `${l.stage}: ${l.p50_ms.toFixed(1)} ms, p99 ${l.p99_ms.toFixed(1)} ms, most ${l.highest_ms.toFixed(0)} ms`)));
  });
  const { gateway } = health;
  const foot = element("p", {}, `gateway: ${gateway.viewers} viewers, ${gateway.dropped_messages} dropped messages, ${Math.round(gateway.memory_mb)} MB`);
  $("health").replaceChildren(element("h2", {}, "Services"), ...services, foot);
}

export const number = (value, digits, unit) => `${value.toFixed(digits)} ${unit}`;
export const degrees = (angle) => `${Math.round((angle * 180) / Math.PI)}°`;

/** points: [[time, value]]; cursor: a time to mark, or nothing. */
export function drawPlot(canvas, points, highest, color, cursor) {
  const ratio = devicePixelRatio || 1;
  const width = canvas.clientWidth || 260, height = canvas.clientHeight || 44;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  if (points.length < 2) return;
  const end = points.at(-1)[0], span = Math.max(10, end - points[0][0]);
  const at = ([time, value]) => [width * (1 - (end - time) / span), height - 4 - (height - 8) * Math.min(1, value / highest)];
  context.beginPath();
  points.forEach((point, i) => context[i ? "lineTo" : "moveTo"](...at(point)));
  context.strokeStyle = css(color);
  context.lineWidth = 1.6;
  context.lineJoin = "round";
  context.stroke();
  context.lineTo(width, height);
  context.lineTo(at(points[0])[0], height);
  context.fillStyle = css(color, 0.14);
  context.fill();
  if (cursor === undefined) return;
  context.fillStyle = css(color);
  context.fillRect(at([cursor, 0])[0] - 0.75, 0, 1.5, height);
}

function rowsOf(track) {
  const sigma = (index) => Math.sqrt(Math.max(0, track.covariance[index]));
  const age = (Number(BigInt(track.last_seen_ns) - BigInt(track.first_seen_ns)) * 1e-9).toFixed(1);
  return [
    ["class", track.class],
    ["state", `${track.occluded ? "occluded, predicted" : track.confirmed ? "confirmed" : "tentative"}, ${track.stopped ? "stopped" : "moving"}`],
    ["speed", `${number(track.speed * 3.6, 1, "km/h")} ± ${(sigma(10) * 3.6).toFixed(1)}`],
    ["acceleration", number(Math.hypot(...track.acceleration), 2, "m/s²")],
    ["heading", degrees(track.heading)],
    ["size", `${track.length.toFixed(1)} × ${track.width.toFixed(1)} m`],
    ["position", `± ${sigma(0).toFixed(2)}, ± ${sigma(5).toFixed(2)} m`],
    ["seen for", `${age} s`],
  ];
}

export const bars = (shares) =>
  element("div", { class: "bars" }, ...shares.flatMap(([name, share]) => [
    element("span", {}, name), element("i", { "--share": `${Math.round(share * 100)}%` }), element("span", {}, `${Math.round(share * 100)} %`)]));

/** Everything known about the selected track. */
export function showDetails(world, options, deselect) {
  const panel = $("details");
  const isHidden = options.selected === null;
  panel.hidden = isHidden || !$("layers").hidden || !$("health").hidden;
  if (panel.hidden) return;
  const track = world.tracks.get(options.selected);
  const close = element("button", { title: "Deselect (Escape)", "aria-label": "Deselect", onclick: deselect }, "×");
  if (!track) {
    panel.replaceChildren(element("h2", {}, `Track ${options.selected}`, close), element("p", {}, "It has ended, or was not seen yet."));
    return;
  }
  const color = THEMES[options.theme][CLASSES[track.class] ?? "other"];
  const history = world.plots.get(track.id) ?? [];
  const plots = [["speed", 1, Math.max(5, ...history.map((entry) => entry[1])), `${(track.speed * 3.6).toFixed(0)} km/h`],
    ["existence", 2, 1, track.existence.toFixed(3)]].map(([name, index, highest, now]) => {
    const canvas = element("canvas");
    return [element("div", { class: "plot" }, name, element("b", {}, now), canvas), canvas, history.map((entry) => [entry[0], entry[index]]), highest];
  });
  const table = element("table", {}, ...rowsOf(track).map(([name, value]) => element("tr", {}, element("td", {}, name), element("td", {}, value))));
  const [velocity, acceleration, turning] = track.mode_probability;
  const [pedestrian, bicycle, car, truck] = track.class_probability;
  panel.replaceChildren(
    element("h2", {}, element("i", { class: "dot", "--dot": "" }), `${track.class} ${track.id}`, close), table, ...plots.map(([node]) => node),
    bars([["constant velocity", velocity], ["acceleration", acceleration], ["turn", turning]]),
    bars([["pedestrian", pedestrian], ["bicycle", bicycle], ["car", car], ["truck or bus", truck]]));
  panel.querySelector(".dot").style.background = css(color);
  for (const [, canvas, points, highest] of plots) drawPlot(canvas, points, highest, color);
}

/** A bar of a round length. */
export function showScale(camera) {
  const widest = 140 * camera.metresPerPixel();
  const power = 10 ** Math.floor(Math.log10(widest));
  const length = [5, 2, 1].map((factor) => factor * power).find((candidate) => candidate <= widest);
  $("scale").firstElementChild.style.width = `${length / camera.metresPerPixel()}px`;
  $("scale").lastElementChild.textContent = length >= 1000 ? `${length / 1000} km` : `${length} m`;
}
