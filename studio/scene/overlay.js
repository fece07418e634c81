/* What is drawn over the scene: names, gaps, sensors, messages, ways, speeds, lamps and notices, on a flat canvas over viser's.
 *
 * The page posts     {studio: "cast", cars: [{name, index, color, length, width, height, middle}]}
 *                    {studio: "layers", on: [name, ...]}
 *                    {studio: "seen", layers: {cars, fields, messages, trails, paths, links} | null}   as the server tells it
 *                    {studio: "marks", marks: {lines: [{points, closed, strong, filled}], knobs, words: [{at, text, strong}], told}}   of the editor
 *
 * It is drawn when the scene has been drawn, where that has the cars, so that nothing lags behind them; and when one of these comes. Nothing
 * hides it: what is behind a house is seen too. What is drawn stands in words in the canvas's label.
 */
(() => {
  "use strict";

  const LAYERS = ["speed", "trails", "paths", "sensors", "gaps", "ghosts", "messages", "lamps", "names", "notices"]; // from below to above
  const NEAR = 0.2; // [m] before the eye, where lines are cut
  const NAMES = { own: 600, traffic: 90 }; // [m] from the eye
  const FONT = '600 12px system-ui, -apple-system, "Segoe UI", sans-serif';
  // Viridis (S. van der Walt, N. Smith, 2015): even to the eye, and for the colour-blind
  const SCALE = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  const FASTEST = 40; // [m/s] at the end of the scale
  const RED = "#ff2a1f", AMBER = "#ffb000", MARK = "#1c7ed6";

  const state = { cars: [], of: new Map(), on: new Set(), seen: null, known: new Map(), canvas: null, told: "", drawn: 0, marks: null, spot };
  const bridge = () => window.__studioBridge;

  // ---- from the scene to the picture

  let project = null;

  // float of the scene's z-up frame → [x, y, w] in pixels of the canvas and metres before the eye
  function projection(camera, width, height) {
    const p = camera.projectionMatrix.elements, v = camera.matrixWorldInverse.elements;
    const along = (m, row, [x, y, z]) => m[row] * x + m[row + 4] * y + m[row + 8] * z + m[row + 12];
    return (point) => {
      const world = bridge().toThree(point);
      const eye = [along(v, 0, world), along(v, 1, world), along(v, 2, world)];
      const w = along(p, 3, eye);
      return [along(p, 0, eye) * width / 2 + w * width / 2, w * height / 2 - along(p, 1, eye) * height / 2, w];
    };
  }

  const flat = ([x, y, w]) => [x / w, y / w];
  const cut = (a, b) => {
    const share = (NEAR - a[2]) / (b[2] - a[2]);
    return [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), NEAR];
  };

  // the parts of a line, or of an outline, that are before the eye
  function before(points, closed) {
    const found = [];
    for (let i = 0; i < points.length; i++) {
      const here = points[i], last = i > 0 ? points[i - 1] : closed ? points[points.length - 1] : null;
      if (last && here[2] >= NEAR !== last[2] >= NEAR) found.push(cut(last, here));
      if (here[2] >= NEAR) found.push(here);
      else if (!closed && found.length && found.at(-1) !== null) found.push(null);
    }
    return found;
  }

  function trace(ink, points, closed = false) {
    const found = before(points.map(project), closed);
    ink.beginPath();
    let up = true;
    for (const point of found) {
      if (point === null) up = true;
      else {
        ink[up ? "moveTo" : "lineTo"](...flat(point));
        up = false;
      }
    }
    if (closed) ink.closePath();
    return found.length > 1;
  }

  function spot(point) {
    const found = project?.(point);
    return found && found[2] >= NEAR ? [...flat(found), found[2]] : null;
  }

  // ---- cars

  const poses = new Map();
  function poseOf(index) {
    if (!poses.has(index)) poses.set(index, bridge().poseOf(index));
    return poses.get(index);
  }

  // a place in the frame of a car, on the map
  function placed(pose, x, y, z) {
    const c = Math.cos(pose.yaw), s = Math.sin(pose.yaw);
    return [pose.x + c * x - s * y, pose.y + s * x + c * y, pose.z + z];
  }

  const isTraffic = (car) => car.name.startsWith("traffic");
  const words = (name) => (name[0].toUpperCase() + name.slice(1)).replaceAll("_", " ");

  function* there() {
    for (const car of state.cars) {
      const pose = poseOf(car.index);
      if (pose) yield [car, pose, state.known.get(car.index)];
    }
  }

  // ---- what there is to be drawn, layer by layer; each returns how much it was

  const draw = {
    speed(ink) {
      let count = 0;
      for (const [car, pose, known] of there()) {
        if (known?.speed == null) continue;
        const corners = [];
        for (const x of [-0.5, 0.5]) for (const y of [-0.5, 0.5]) for (const z of [0.15, 1])
          corners.push(spot(placed(pose, car.middle + x * car.length, y * car.width, z * car.height)));
        if (corners.includes(null)) continue;
        ink.fillStyle = colour(known.speed, 0.62);
        outline(ink, hull(corners));
        ink.fill();
        count++;
      }
      if (count) legend(ink);
      return count;
    },

    trails: (ink) => lines(ink, state.seen?.trails, (line, pose) => [...risen(line), [pose.x, pose.y, pose.z]], { width: 3, alpha: 0.75 }),

    paths: (ink) => lines(ink, state.seen?.paths, risen, { width: 4, alpha: 0.5, dash: [2, 6], cap: "round" }),

    sensors(ink) {
      let count = 0;
      for (const field of state.seen?.fields ?? []) {
        const pose = poseOf(field.car), car = state.of.get(field.car);
        if (!pose || !car) continue;
        ink.strokeStyle = ink.fillStyle = shown(car.color);
        ink.globalAlpha = 0.13;
        if (trace(ink, fan(field, pose), true)) ink.fill();
        ink.globalAlpha = 0.7;
        ink.lineWidth = 1.2;
        ink.stroke();
        ink.globalAlpha = 1;
        ink.lineWidth = 2;
        for (const [x, y] of field.seen) {
          const at = spot(placed(pose, x, y, 0.6));
          if (at) target(ink, at);
          count++;
        }
      }
      return count;
    },

    gaps(ink) {
      let count = 0;
      for (const [car, pose, known] of there()) {
        if (known?.gap == null || known.ahead == null) continue;
        const other = state.of.get(known.ahead), ahead = poseOf(known.ahead);
        if (!other || !ahead) continue;
        const from = placed(pose, car.middle + car.length / 2, 0, 0.35), to = placed(ahead, other.middle - other.length / 2, 0, 0.35);
        ink.strokeStyle = "#ffffff";
        ink.lineWidth = 2;
        if (trace(ink, [from, to])) ink.stroke();
        const at = spot(from.map((value, i) => (value + to[i]) / 2));
        if (at && at[2] < NAMES.own && (!isTraffic(car) || at[2] < NAMES.traffic)) plate(ink, at, `${known.gap.toFixed(1)} m`, "#101418");
        count++;
      }
      return count;
    },

    // to the same car of the other runs that are among these
    ghosts(ink) {
      let count = 0;
      ink.setLineDash([5, 4]);
      for (const link of state.seen?.links ?? []) {
        const pose = poseOf(link.car);
        if (!pose) continue;
        const from = [pose.x, pose.y, pose.z + 0.9], to = [link.x, link.y, link.z + 0.9];
        ink.strokeStyle = link.color;
        ink.lineWidth = 2;
        if (trace(ink, [from, to])) ink.stroke();
        const at = spot(from.map((value, i) => (value + to[i]) / 2));
        if (at && at[2] < NAMES.own) plate(ink, at, `${link.distance.toFixed(1)} m`, "#101418");
        count++;
      }
      ink.setLineDash([]);
      return count;
    },

    messages(ink) {
      let count = 0;
      for (const message of state.seen?.messages ?? []) {
        const [from, to] = [message.sender, message.receiver].map(antenna);
        if (!from || !to) continue;
        ink.strokeStyle = message.lost ? "#ff5a4d" : "#49d6ff";
        ink.setLineDash(message.lost ? [7, 6] : []);
        ink.lineWidth = 2;
        if (trace(ink, arc(from, to))) ink.stroke();
        ink.setLineDash([]);
        const end = spot(message.lost ? arc(from, to)[ARC / 2] : arc(from, to)[ARC - 1]);
        if (end) (message.lost ? cross : tip)(ink, end, spot(to));
        count++;
      }
      return count;
    },

    lamps(ink) {
      let count = 0;
      const eye = bridge().client().camera.position;
      for (const [car, pose, known] of there()) {
        if (!known || !(known.brakes || known.turns)) continue;
        const side = car.width / 2 - 0.22, rear = car.middle - car.length / 2, front = car.middle + car.length / 2;
        const at = (x, y) => placed(pose, x, y, 0.53 * car.height);
        const isSeen = (x, sign) => {
          const [px, py, pz] = bridge().toThree(at(x, 0)), [dx, dy, dz] = bridge().toThree([Math.cos(pose.yaw) * sign, Math.sin(pose.yaw) * sign, 0]);
          return (eye.x - px) * dx + (eye.y - py) * dy + (eye.z - pz) * dz > 0;
        };
        if (known.brakes && isSeen(rear, -1)) for (const y of [side, -side]) glow(ink, at(rear, y), RED);
        for (const [x, sign] of [[rear, -1], [front, 1]]) if (known.turns && isSeen(x, sign)) glow(ink, at(x, known.turns * side), AMBER);
        count++;
      }
      return count;
    },

    names(ink) {
      let count = 0;
      const taken = [];
      for (const [car, pose, at] of nearestFirst()) {
        if (at[2] > (isTraffic(car) ? NAMES.traffic : NAMES.own)) continue;
        const followed = bridge().view.vehicle === car.index;
        count += plate(ink, at, words(car.name), followed ? "#0b5cad" : "#101418", shown(car.color), taken);
      }
      return count;
    },

    notices(ink) {
      let count = 0;
      for (const [car, pose, known] of there()) {
        const at = known?.notice ? spot(placed(pose, car.middle, 0, car.height + 1.6)) : null;
        if (at) count += plate(ink, [at[0], at[1] - 22], `⚠ ${known.notice}`, "#7a2e00");
      }
      return count;
    },
  };

  // what is chosen in the editor, what is held, and where it can be taken hold of
  function mark(ink, { lines: some, knobs, words: names, told }) {
    for (const { points, closed, strong, filled } of some) {
      if (points.length < 2 || !trace(ink, points, closed)) continue;
      Object.assign(ink, { strokeStyle: MARK, fillStyle: MARK, lineWidth: strong ? 2.5 : 1.5, lineJoin: "round" });
      ink.globalAlpha = 0.35;
      if (filled) ink.fill();
      ink.globalAlpha = strong ? 1 : 0.7;
      ink.stroke();
    }
    ink.globalAlpha = 1;
    for (const at of knobs.map(spot)) if (at) knob(ink, at);
    const taken = [];
    for (const { at, text, strong } of names) if (spot(at)) plate(ink, spot(at), text, strong ? "#0b5cad" : "#101418", null, taken);
    return told;
  }

  function knob(ink, [x, y]) {
    Object.assign(ink, { fillStyle: "#ffffff", strokeStyle: MARK, lineWidth: 2.5 });
    ink.beginPath();
    ink.arc(x, y, 6, 0, 7);
    ink.fill();
    ink.stroke();
  }

  function nearestFirst() {
    const found = [];
    for (const [car, pose] of there()) {
      const at = spot(placed(pose, car.middle, 0, car.height + 0.7));
      if (at) found.push([car, pose, at]);
    }
    return found.sort((one, other) => isTraffic(one[0]) - isTraffic(other[0]) || one[2][2] - other[2][2]);
  }

  // the points of a line, as high as the road is drawn there
  function risen({ points, lifts }) {
    return points.map(([x, y], i) => [x, y, lifts?.[i] ?? 0]);
  }

  function lines(ink, some, points, { width, alpha, dash = [], cap = "butt" }) {
    let count = 0;
    for (const line of some ?? []) {
      const pose = poseOf(line.car), car = state.of.get(line.car);
      if (!pose || !car) continue;
      Object.assign(ink, { strokeStyle: shown(car.color), lineWidth: width, globalAlpha: alpha, lineCap: cap });
      ink.setLineDash(dash);
      if (trace(ink, points(line, pose).map(([x, y, z]) => [x, y, z + 0.15]))) ink.stroke();
      count++;
    }
    ink.setLineDash([]);
    return count;
  }

  // ---- shapes

  function fan({ x, y, yaw, range, angle }, pose) {
    const steps = Math.max(4, Math.ceil(angle / 0.1)), points = angle > 6.28 ? [] : [placed(pose, x, y, 0.15)];
    for (let i = 0; i <= steps; i++) {
      const a = yaw - angle / 2 + (angle * i) / steps;
      points.push(placed(pose, x + range * Math.cos(a), y + range * Math.sin(a), 0.15));
    }
    return points;
  }

  const ARC = 12; // points
  function arc(from, to) {
    const rise = Math.min(6, 0.5 + 0.06 * Math.hypot(to[0] - from[0], to[1] - from[1]));
    return Array.from({ length: ARC }, (_, i) => {
      const share = i / (ARC - 1);
      return [0, 1, 2].map((k) => from[k] + share * (to[k] - from[k]) + (k === 2 ? 4 * rise * share * (1 - share) : 0));
    });
  }

  function antenna({ car, x, y }) {
    if (car === null || car === undefined) return [x, y, 5];
    const pose = poseOf(car), own = state.of.get(car);
    return pose && own ? placed(pose, own.middle, 0, own.height + 0.1) : null;
  }

  function target(ink, [x, y]) {
    ink.beginPath();
    for (const [dx, dy] of [[0, -7], [7, 0], [0, 7], [-7, 0]]) ink.lineTo(x + dx, y + dy);
    ink.closePath();
    ink.stroke();
  }

  function cross(ink, [x, y]) {
    ink.lineWidth = 3;
    ink.beginPath();
    for (const sign of [1, -1]) {
      ink.moveTo(x - 6, y - 6 * sign);
      ink.lineTo(x + 6, y + 6 * sign);
    }
    ink.stroke();
  }

  function tip(ink, [x, y]) {
    ink.fillStyle = ink.strokeStyle;
    ink.beginPath();
    ink.arc(x, y, 4, 0, 7);
    ink.fill();
  }

  function glow(ink, place, colour) {
    const at = spot(place);
    if (!at) return;
    const size = Math.min(40, Math.max(3, 260 / at[2]));
    const light = ink.createRadialGradient(at[0], at[1], 0, at[0], at[1], size);
    light.addColorStop(0, colour);
    light.addColorStop(0.35, `${colour}c0`);
    light.addColorStop(1, `${colour}00`);
    ink.fillStyle = light;
    ink.beginPath();
    ink.arc(at[0], at[1], size, 0, 7);
    ink.fill();
  }

  // words on a plate; not where another stands already
  function plate(ink, [x, y], text, ground, mark = null, taken = null) {
    const width = ink.measureText(text).width + 12 + (mark ? 12 : 0), left = x - width / 2, top = y - 18;
    if (taken?.some(([l, t, w]) => left < l + w && l < left + width && Math.abs(top - t) < 18)) return 0;
    taken?.push([left, top, width]);
    Object.assign(ink, { globalAlpha: 0.86, fillStyle: ground });
    ink.beginPath();
    ink.roundRect(left, top, width, 18, 4);
    ink.fill();
    ink.globalAlpha = 1;
    if (mark) {
      ink.fillStyle = mark;
      ink.fillRect(left + 6, top + 5, 8, 8);
    }
    ink.fillStyle = "#ffffff";
    ink.fillText(text, left + 6 + (mark ? 12 : 0), top + 13);
    return 1;
  }

  function outline(ink, points) {
    ink.beginPath();
    for (const [x, y] of points) ink.lineTo(x, y);
    ink.closePath();
  }

  // the outline of some points of the picture (A. M. Andrew's monotone chain, 1979)
  function hull(points) {
    const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    const half = (some) => {
      const chain = [];
      for (const point of some) {
        while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), point) <= 0) chain.pop();
        chain.push(point);
      }
      return chain.slice(0, -1);
    };
    return [...half(sorted), ...half(sorted.reverse())];
  }

  // ---- colours

  function colour(speed, alpha) {
    const at = Math.min(Math.max(speed / FASTEST, 0), 1) * (SCALE.length - 1), i = Math.min(Math.floor(at), SCALE.length - 2);
    const rgb = SCALE[i].map((value, k) => Math.round(value + (at - i) * (SCALE[i + 1][k] - value)));
    return `rgba(${rgb.join()},${alpha})`;
  }

  // a dark paint is no line on a dark road
  function shown(paint) {
    const rgb = [1, 3, 5].map((at) => Number.parseInt(paint.slice(at, at + 2), 16));
    const light = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
    const share = light > 120 ? 0 : (120 - light) / 200;
    return `rgb(${rgb.map((value) => Math.round(value + share * (255 - value))).join()})`;
  }

  function legend(ink) {
    const width = 160, left = 12, top = state.canvas.clientHeight - 58;
    Object.assign(ink, { globalAlpha: 0.86, fillStyle: "#101418" });
    ink.beginPath();
    ink.roundRect(left, top, width + 16, 36, 4);
    ink.fill();
    ink.globalAlpha = 1;
    for (let i = 0; i < width; i++) {
      ink.fillStyle = colour((i / width) * FASTEST, 1);
      ink.fillRect(left + 8 + i, top + 5, 1, 8);
    }
    ink.fillStyle = "#ffffff";
    for (const share of [0, 0.5, 1]) {
      const text = share === 1 ? `${FASTEST} m/s` : String(share * FASTEST);
      ink.fillText(text, left + 8 + share * (width - ink.measureText(text).width), top + 28);
    }
  }

  // ---- when

  function paint() {
    const { client } = bridge(), camera = client()?.camera, below = client()?.canvas;
    if (!camera || !below) return;
    const canvas = (state.canvas ??= made(below));
    const width = below.clientWidth, height = below.clientHeight, dots = window.devicePixelRatio || 1;
    if (canvas.width !== Math.round(width * dots) || canvas.height !== Math.round(height * dots)) {
      Object.assign(canvas, { width: Math.round(width * dots), height: Math.round(height * dots) });
      Object.assign(canvas.style, { width: `${width}px`, height: `${height}px` });
    }
    const ink = canvas.getContext("2d");
    ink.setTransform(dots, 0, 0, dots, 0, 0);
    ink.clearRect(0, 0, width, height);
    poses.clear();
    project = projection(camera, width, height);
    const told = [];
    for (const name of LAYERS) {
      if (!state.on.has(name)) continue;
      ink.save();
      ink.font = FONT;
      ink.lineJoin = "round";
      const count = draw[name](ink);
      ink.restore();
      told.push(`${name} ${count}`);
    }
    if (state.marks) {
      ink.font = FONT;
      told.push(...[mark(ink, state.marks)].filter(Boolean));
    }
    tell(told.join(", "));
    state.drawn++;
  }

  function tell(text) {
    if (text === state.told) return;
    state.told = text;
    state.canvas.setAttribute("aria-label", `Layers: ${text || "none"}`);
  }

  function made(below) {
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    Object.assign(canvas.style, { position: "fixed", left: "0", top: "0", zIndex: "1", pointerEvents: "none" });
    canvas.id = "studio-overlay";
    document.body.append(canvas);
    void below;
    return canvas;
  }

  let due = false;
  // at once when the scene rests, and else with its next picture
  function soon() {
    if (due) return;
    due = true;
    requestAnimationFrame(() => {
      due = false;
      paint();
    });
  }

  window.addEventListener("message", ({ origin, data }) => {
    if (origin !== location.origin || typeof data !== "object" || data === null) return;
    if (data.studio === "cast") {
      state.cars = data.cars;
      state.of = new Map(data.cars.map((car) => [car.index, car]));
      state.known = new Map();
      state.seen = null;
    } else if (data.studio === "layers") {
      state.on = new Set(data.on);
    } else if (data.studio === "seen") {
      state.seen = data.layers;
      state.known = new Map((data.layers?.cars ?? []).map((car) => [car.car, car]));
    } else if (data.studio === "marks") {
      state.marks = data.marks;
    } else return;
    soon();
  });

  function hook() {
    const scene = bridge()?.client()?.scene;
    if (!scene || scene.userData.overlaid) return;
    scene.userData.overlaid = true;
    scene.onAfterRender = (_renderer, _scene, camera) => {
      if (camera === bridge().client().camera) paint();
    };
  }

  setInterval(hook, 200);
  window.__studioOverlay = state;
})();
