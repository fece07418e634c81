/* Bridge between the studio's page and the viser client in its frame (viser 1.1.1).
 *
 * The page posts     {studio: "follow", vehicle: index|null}
 *                    {studio: "view", preset: "overview"|"top"|"driver"}
 *                    {studio: "theme", dark: bool}
 *                    {studio: "camera", camera: {azimuth, polar, distance, at?}}   as a link has it: free, or for who is followed
 *                    {studio: "rest", rest: bool}   nobody sees the scene: nothing is drawn
 * The bridge posts   {studio: "ready", follow: bool}, {studio: "picked", vehicle: index},
 *                    {studio: "key", key, code, ctrlKey, metaKey, shiftKey, altKey}
 *
 * viser has no public interface for any of this. Everything is looked up before it is used, so that a client
 * without these internals still shows the scene, only without following, views and theme.
 */
(() => {
  "use strict";

  // The client retries a lost connection only while its own frame has the focus, and the focus is in the page.
  document.hasFocus = () => true;

  const VEHICLES = "/vehicles/shadows"; // instance i is vehicle i
  // flat layers carry their light in their colours
  const LEVEL = ["/city/ground", "/city/areas", "/city/shoulder", "/city/road", "/city/markings"];
  const HIDDEN_BELOW = -100;
  const CHASE = { distance: 13, polar: 1.28, height: 1.1 };
  const DRIVER = { forward: 0.15, height: 1.17, left: 0.32, distance: 0.25, polar: 1.535 };
  const TOP = { distance: 70, polar: 0.02, height: 0 };
  const YAW_LAG = 0.35; // [s]
  const NEAR_ENOUGH = 3; // times as far as what an overview looks at: cars are still to be seen there
  const KEYS_OF_THE_CAMERA = new Set(["KeyW", "KeyA", "KeyS", "KeyD", "KeyQ", "KeyE", "ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight", "Tab"]);

  const view = { vehicle: null, mode: CHASE, yaw: 0, target: null, fresh: false, time: 0, dark: false, lost: false, wanted: null };
  const SETTLING = 5; // looks at a city that has just come, while the client turns to the overview
  let ready = false;
  let shownCity = null;
  let settled = 0;
  let painted = null;
  const summed = { data: null, sum: null };

  const client = () => window.__viserMutable;
  const tree = () => (window.__viserSceneTree ? window.__viserSceneTree.getState() : {});
  const tell = (message) => {
    if (window.parent !== window) window.parent.postMessage(message, location.origin);
  };

  // ---- vehicles: read where they are drawn, not where the last message put them

  function instances() {
    return batchIn(client()?.nodeRefFromName?.[VEHICLES]);
  }

  // the batch itself: below it are those of its simpler shapes, with the same places
  function batchIn(node) {
    let found = null;
    node?.traverse((object) => {
      if (object.matricesTexture && !object._parentLOD) found = object;
    });
    return found;
  }

  function poseOf(index) {
    const mesh = instances();
    const data = mesh?.matricesTexture?._data ?? mesh?.matricesTexture?.image?.data;
    if (!data || index === null || index >= mesh.instancesCount / 2) return null;
    const m = data.subarray(16 * index, 16 * index + 16);
    return m[14] < HIDDEN_BELOW ? null : { x: m[12], y: m[13], z: m[14], yaw: Math.atan2(m[1], m[0]) };
  }

  // ---- three's frame is y-up; the scene's root carries the turn between the two

  function toThree([x, y, z]) {
    const [w, a, b, c] = tree()[""]?.wxyz ?? [1, 0, 0, 0];
    const tx = 2 * (b * z - c * y), ty = 2 * (c * x - a * z), tz = 2 * (a * y - b * x);
    return [x + w * tx + b * tz - c * ty, y + w * ty + c * tx - a * tz, z + w * tz + a * ty - b * tx];
  }

  // azimuth of camera-controls that looks along a heading of the scene
  function azimuthBehind(yaw) {
    const [x, , z] = toThree([-Math.cos(yaw), -Math.sin(yaw), 0]);
    return Math.atan2(x, z);
  }

  const turn = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));

  // ---- following

  function lookedAt(pose) {
    const { forward = 0, left = 0, height } = view.mode;
    const c = Math.cos(pose.yaw), s = Math.sin(pose.yaw);
    return toThree([pose.x + c * forward - s * left, pose.y + s * forward + c * left, pose.z + height]);
  }

  function follow(vehicle) {
    view.vehicle = Number.isInteger(vehicle) ? vehicle : null;
    view.fresh = true;
    view.lost = false;
    if (view.vehicle === null && view.mode === DRIVER) view.mode = CHASE;
    client()?.requestRender?.();
  }

  // Called when a frame is about to be drawn: the camera goes exactly as far as the vehicle has gone.
  function beforeDrawing() {
    const controls = client()?.cameraControl, camera = client()?.camera;
    if (!controls || !camera) return;
    adaptNear(camera);
    const pose = view.vehicle === null ? null : poseOf(view.vehicle);
    if (!pose) return;
    const now = performance.now() / 1000;
    const target = lookedAt(pose);
    if (view.fresh) return start(controls, pose, target, now);
    const [dx, dy, dz] = target.map((value, i) => value - view.target[i]);
    if (dx * dx + dy * dy + dz * dz > 100 * 100) return start(controls, pose, target, now);
    swing(controls, pose, now);
    // who is told to move asks for another picture: a car that stands would have itself drawn for ever
    if (dx * dx + dy * dy + dz * dz < 1e-8) return;
    camera.position.set(camera.position.x + dx, camera.position.y + dy, camera.position.z + dz);
    camera.updateMatrixWorld();
    controls.moveTo(...target, false);
    view.target = target;
  }

  function start(controls, pose, target, now) {
    const { azimuth: more = 0, polar = view.mode.polar, distance = view.mode.distance } = view.wanted ?? {};
    const azimuth = (view.mode === TOP && !view.wanted ? controls.azimuthAngle : azimuthBehind(pose.yaw)) + more;
    controls.moveTo(...target, false);
    controls.rotateTo(controls.azimuthAngle + turn(azimuth - controls.azimuthAngle), polar, false);
    controls.dollyTo(distance, false);
    Object.assign(view, { fresh: false, target, yaw: pose.yaw, time: now, wanted: null });
  }

  // ---- the camera of a link: free in the picture, or turned from behind who is followed

  function camera() {
    const controls = client()?.cameraControl;
    if (!controls?.getTarget) return null;
    const pose = view.vehicle === null ? null : poseOf(view.vehicle);
    const { azimuthAngle, polarAngle: polar, distance } = controls;
    if (pose) return { azimuth: turn(azimuthAngle - azimuthBehind(pose.yaw)), polar, distance };
    const { x, y, z } = controls.getTarget(client().camera.position.clone());
    return { azimuth: turn(azimuthAngle), polar, distance, at: [x, y, z] };
  }

  function want(camera) {
    const { azimuth, polar, distance, at } = camera ?? {};
    if (![azimuth, polar, distance, ...(at ?? [])].every(Number.isFinite)) return;
    Object.assign(view, { wanted: { azimuth, polar, distance, at }, fresh: true });
    client()?.requestRender?.();
  }

  // a free camera waits for the city, at whose coming the client turns to the overview
  function restore() {
    const controls = client()?.cameraControl;
    if (!view.wanted?.at || shownCity === null || settled < SETTLING || !controls) return;
    const { azimuth, polar, distance, at } = view.wanted;
    controls.moveTo(...at, false);
    controls.rotateTo(controls.azimuthAngle + turn(azimuth - controls.azimuthAngle), polar, false);
    controls.dollyTo(distance, false);
    view.wanted = null;
    client().requestRender?.();
  }

  // the camera comes round behind the vehicle a little later, and keeps what the user has turned it by
  function swing(controls, pose, now) {
    const share = view.mode === DRIVER ? 1 : 1 - Math.exp(-Math.min(now - view.time, 0.1) / YAW_LAG);
    view.time = now;
    if (view.mode === TOP) return;
    const step = turn(pose.yaw - view.yaw) * share;
    view.yaw += step;
    if (Math.abs(step) > 1e-5) controls.rotate(step, 0, false);
  }

  // A far near plane keeps the thin layers of the street apart from high above, a close one shows the bonnet.
  function adaptNear(camera) {
    const near = Math.min(6, Math.max(0.3, camera.position.y * 0.25));
    if (Math.abs(near - camera.near) < 0.1 * camera.near) return;
    camera.near = near;
    camera.updateProjectionMatrix();
  }

  function show(preset) {
    if (preset === "overview") {
      follow(null);
      client()?.resetCameraPose?.(true);
      view.lost = true;
      findCars();
    } else if (preset === "driver" || preset === "chase") {
      view.mode = preset === "driver" ? DRIVER : CHASE;
      follow(view.vehicle ?? 0);
    } else if (preset === "top") {
      fromAbove();
    }
  }

  // The overview of a map that is too large for one look shows a part of it: when the cars are not there, it goes over to where they are.
  // Once, as soon as they are known: who has turned the camera meanwhile has it left alone.
  function findCars() {
    const controls = client()?.cameraControl, places = view.lost ? ownPlaces() : [];
    if (!places.length || !controls?.getTarget) return;
    view.lost = false;
    const at = client().camera.clone(), target = controls.getTarget(at.position.clone(), true), eye = controls.getPosition(at.position.clone(), true);
    const middle = target.clone().set(...[0, 1, 2].map((k) => places.reduce((sum, place) => sum + place[k], 0) / places.length));
    at.position.copy(eye);
    at.lookAt(target);
    at.updateMatrixWorld();
    const { x, y } = middle.clone().project(at);
    const ahead = middle.clone().sub(eye).dot(target.clone().sub(eye)) > 0, near = middle.distanceTo(eye) < NEAR_ENOUGH * target.distanceTo(eye);
    if (ahead && near && Math.max(Math.abs(x), Math.abs(y)) < 0.9) return;
    const away = middle.sub(target);
    controls.setLookAt(...eye.add(away).toArray(), ...target.add(away).toArray(), true);
  }

  // where the scenario's own cars stand, as far as they are there
  function ownPlaces() {
    const cars = window.__studioOverlay?.cars.filter(({ name }) => !name.startsWith("traffic")) ?? [];
    return cars.flatMap(({ index }) => poseOf(index) ?? []).map(({ x, y, z }) => toThree([x, y, z]));
  }

  function fromAbove() {
    view.mode = TOP;
    view.fresh = true;
    const controls = client()?.cameraControl;
    if (view.vehicle === null) controls?.rotateTo(controls.azimuthAngle, TOP.polar, true);
    client()?.requestRender?.();
  }

  // ---- from afar: who is far from the eye is drawn in a simpler shape, which the server has sent beside the batch

  const SIMPLER = /^\/afar\/(\w+)\/(\d+)$/; // the batch, and from how far on [m]

  function simplify() {
    for (const name of Object.keys(tree())) {
      const [, batch, distance] = SIMPLER.exec(name) ?? [];
      if (batch) takeUp(batchIn(client().nodeRefFromName[`/vehicles/${batch}`]), shapeIn(client().nodeRefFromName[name]), Number(distance));
    }
  }

  function shapeIn(node) {
    let found = null;
    node?.traverse((object) => (found ??= object.geometry));
    return found;
  }

  // a batch that was made anew has none of them, and one that was painted anew has those of before
  function takeUp(mesh, shape, distance) {
    if (!mesh?.addLOD || !shape) return;
    const known = (mesh.userData.simpler ??= new Map());
    if (known.get(distance) === shape) return;
    const level = mesh.LODinfo?.render?.levels.findIndex((each) => each.distance === distance ** 2) ?? -1;
    if (level > 0) mesh.removeLOD(level);
    mesh.addLOD(shape.clone(), mesh.material.clone(), distance);
    known.set(distance, shape);
    client().requestRender?.();
  }

  // ---- theme: dusk instead of day

  function paint() {
    const scene = client()?.scene;
    if (!scene) return;
    const sky = client().nodeRefFromName["/city/sky"];
    sky?.traverse((object) => object.material && paintSky(object.material));
    scene.traverse((object) => {
      if (object.isLight) dim(object);
    });
    for (const layer of LEVEL) client().nodeRefFromName[layer]?.traverse((object) => object.material?.color.setScalar(daylight()));
    if (scene.fog) tint(scene.fog);
    client().requestRender?.();
  }

  function paintSky(material) {
    // the dome lies beyond the haze and must not vanish in it; its colours are meant as they are
    if (material.fog || material.toneMapped) Object.assign(material, { fog: false, toneMapped: false, needsUpdate: true });
    material.color.setRGB(...(view.dark ? [0.05, 0.075, 0.13] : [1, 1, 1]));
  }

  const daylight = () => (view.dark ? 0.34 : 1);

  function dim(light) {
    light.userData.day ??= light.intensity;
    light.intensity = light.userData.day * daylight();
  }

  function tint(fog) {
    fog.day ??= fog.color.clone();
    fog.color.copy(fog.day);
    if (view.dark) fog.color.setRGB(fog.day.r * 0.05, fog.day.g * 0.075, fog.day.b * 0.13);
  }

  // ---- picking: the vehicle whose middle is seen nearest to the pointer, measured by its size in the picture

  function pick(event) {
    const camera = client()?.camera, canvas = client()?.canvas;
    const mesh = instances();
    if (!camera || !canvas || !mesh) return;
    const box = canvas.getBoundingClientRect();
    let best = null, nearest = 1;
    for (let i = 0; i < mesh.instancesCount / 2; i++) {
      const pose = poseOf(i);
      if (!pose) continue;
      const middle = camera.position.clone().set(...toThree([pose.x, pose.y, pose.z + 0.7]));
      const size = Math.max(14, (2.3 * box.height) / (2 * Math.tan((camera.fov * Math.PI) / 360) * camera.position.distanceTo(middle)));
      const at = middle.project(camera);
      if (at.z < -1 || at.z > 1) continue;
      const away = Math.hypot(box.left + ((at.x + 1) / 2) * box.width - event.clientX, box.top + ((1 - at.y) / 2) * box.height - event.clientY);
      if (away < size && away / size < nearest) [best, nearest] = [i, away / size];
    }
    if (best !== null) tell({ studio: "picked", vehicle: best });
  }

  function listenToPointer() {
    let down = null;
    window.addEventListener("pointerdown", (event) => {
      down = [event.clientX, event.clientY, event.button];
      view.lost = false;
      // the client keeps the click from giving us the focus, and with it the keys that move the camera
      window.focus();
    }, true);
    window.addEventListener("pointerup", (event) => {
      const still = down && down[2] === 0 && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5;
      if (still && event.target instanceof HTMLCanvasElement) pick(event);
      down = null;
    }, true);
  }

  // ---- keys: the page's shortcuts work while the pointer is in the scene

  window.addEventListener("keydown", (event) => {
    if (KEYS_OF_THE_CAMERA.has(event.code) && !event.ctrlKey && !event.metaKey) return;
    const { key, code, ctrlKey, metaKey, shiftKey, altKey } = event;
    tell({ studio: "key", key, code, ctrlKey, metaKey, shiftKey, altKey });
    event.stopImmediatePropagation();
    if (key === " " || ((ctrlKey || metaKey) && key.toLowerCase() === "k")) event.preventDefault();
  }, true);

  window.addEventListener("message", (event) => {
    if (event.origin !== location.origin || typeof event.data !== "object" || event.data === null) return;
    const { studio, vehicle, preset, dark, rest } = event.data;
    if (studio === "rest") {
      resting = rest === true;
      if (!resting) client()?.requestRender?.();
    }
    if (studio === "follow") {
      if (view.mode === TOP && vehicle !== null) view.mode = CHASE;
      follow(vehicle);
    }
    if (studio === "view") show(preset);
    if (studio === "camera") want(event.data.camera);
    if (studio === "theme") {
      view.dark = dark === true;
      paint();
    }
  });

  // ---- rest: nothing is drawn while nobody sees it, nor over and over while nothing changes

  const HEARTBEAT = 1000; // [ms] at which viser draws in case that somebody forgot to ask
  const AWAKE = 5000; // [ms] after somebody has asked, in which it may
  let stirred = performance.now();
  let resting = false;
  const stir = () => (stirred = performance.now());
  const repeat = window.setInterval.bind(window);
  window.setInterval = (call, every, ...rest) =>
    repeat(every === HEARTBEAT && typeof call === "function" ? () => performance.now() - stirred < AWAKE && call() : call, every, ...rest);
  for (const kind of ["pointerdown", "pointermove", "wheel", "resize", "keydown"]) window.addEventListener(kind, stir, true);

  // who asks for a picture is heard, as before
  function listenToRequests() {
    const mutable = client();
    if (!mutable?.requestRender || mutable.requestRender.studio) return;
    const ask = mutable.requestRender;
    mutable.requestRender = Object.assign(() => (stir(), ask(), takeInSoon()), { studio: true });
  }

  // ---- where everything has moved to is taken in when it comes, at a pace of its own: the client waits for the next picture, and then shows
  // it in the one after that, which is long where pictures are slow

  const MOVES = "SceneNodeUpdateMessage";
  const BETWEEN = 20; // [ms] from one to the next, so that pictures that are quick have taken it in by then
  let takenIn = 0, coming = false;

  function takeInSoon() {
    if (coming || !client()?.messageQueue?.length) return;
    coming = true;
    setTimeout(takeIn, Math.max(0, takenIn + BETWEEN - performance.now()));
  }

  function takeIn() {
    coming = false;
    const { messageQueue: queue, drainMessageQueue: drain, getRenderRequestState: state } = client() ?? {};
    if (!drain || state !== "ready" || !queue.length || !queue.every(({ type }) => type === MOVES)) return;
    takenIn = performance.now();
    drain();
  }

  function restWhileUnseen(renderer) {
    if (renderer.render.studio) return;
    const draw = renderer.render.bind(renderer);
    renderer.render = Object.assign((...what) => resting || draw(...what), { studio: true });
  }

  // ---- the client comes up in its own time, and rebuilds its scene when it reconnects

  function hook() {
    const scene = client()?.scene;
    listenToRequests();
    if (scene && !scene.userData.studio) {
      scene.userData.studio = true;
      scene.onBeforeRender = (renderer) => {
        restWhileUnseen(renderer);
        beforeDrawing();
      };
    }
  }

  function watch() {
    hook();
    simplify();
    findCars();
    const city = streets();
    const sky = client()?.nodeRefFromName?.["/city/sky"];
    const material = sky && findMaterial(sky);
    if (material && material !== painted) {
      painted = material;
      paint();
    }
    if (city !== shownCity && city !== null) {
      if (shownCity !== null || view.vehicle === null) show("overview");
      shownCity = city;
      settled = 0;
    }
    settled += 1;
    restore();
    if (!ready && client()?.cameraControl && client()?.scene) {
      ready = true;
      tell({ studio: "ready", follow: typeof client().cameraControl.moveTo === "function" });
    }
  }

  // tells one city from another, and knows it again after a reconnection
  function streets() {
    const data = tree()["/city/road"]?.message?.props?.glb_data;
    if (data && data !== summed.data) {
      let sum = data.byteLength;
      for (const byte of data) sum = (sum * 31 + byte) | 0;
      Object.assign(summed, { data, sum });
    }
    return data ? summed.sum : null;
  }

  function findMaterial(node) {
    let found = null;
    node.traverse((object) => (found ??= object.material));
    return found;
  }

  listenToPointer();
  setInterval(watch, 200);
  window.__studioBridge = { view, poseOf, toThree, client, camera };
})();
