/* The hand of the editor in the scene: what the pointer does is told to the page as a ray of sight, and where the page takes it, the camera
 * stays. The page and this frame are of one origin, so it is asked, not written to: the answer decides whose the press is.
 *
 * The page sets      window.__studioHand.ask = ({phase, ray: {from, along}, at: {x, y}, add, spot}) => boolean
 * and calls          window.__studioHand.look([x, y, z], distance)   to have the camera look at a place from as far [m]
 *
 * It comes behind the bridge, which hears every press too, and before the client, which does not hear of those that are taken.
 */
(() => {
  "use strict";

  const STILL = 5; // [px] that a click may move
  const hand = { ask: null, look };
  const bridge = () => window.__studioBridge;
  const LATE = 100; // [ms] a page that is later than this is busy
  const TREMBLES = 10; // [px] that a finger may move meanwhile
  const RESTS = 550; // [ms] until a finger is the button at the right
  let held = false, pressed = null, first = null, timer = 0, passing = false;

  // a vector of three's frame in that of the scene, which is turned against it
  function fromThree({ x, y, z }) {
    return [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => {
      const [a, b, c] = bridge().toThree(axis);
      return a * x + b * y + c * z;
    });
  }

  function ask(phase, event) {
    const { camera, canvas } = bridge()?.client() ?? {};
    if (!hand.ask || !camera || !canvas) return false;
    const box = canvas.getBoundingClientRect(), at = { x: event.clientX - box.left, y: event.clientY - box.top };
    const through = camera.position.clone().set((2 * at.x) / box.width - 1, 1 - (2 * at.y) / box.height, 0.5).unproject(camera);
    const ray = { from: fromThree(camera.position), along: fromThree(through.sub(camera.position).normalize()) };
    const add = event.shiftKey || event.ctrlKey || event.metaKey;
    return hand.ask({ phase, ray, at, add, spot: window.__studioOverlay.spot });
  }

  function take(event) {
    event.stopImmediatePropagation();
    event.preventDefault();
  }

  function look(place, distance) {
    const { cameraControl: controls, requestRender } = bridge()?.client() ?? {};
    controls?.moveTo?.(...bridge().toThree(place), true);
    controls?.dollyTo?.(distance, true);
    requestRender?.();
  }

  const isOnPicture = ({ target }) => target instanceof HTMLCanvasElement;

  // What a finger holds is let go of, and the camera is told of the finger after all.
  function release() {
    if (!held) return;
    held = false;
    ask("cancel", first);
    passing = true;
    first.target.dispatchEvent(new PointerEvent("pointerdown", first));
    passing = false;
  }

  // A second finger makes it the camera's; one that rests is the button at the right. Whether the press is nothing else.
  function touches(event) {
    clearTimeout(timer);
    if (event.pointerType !== "touch" || !isOnPicture(event)) return false;
    if (!event.isPrimary) {
      pressed = null;
      release();
      return true;
    }
    first = event;
    rest(RESTS, event);
    return false;
  }

  // a busy page may not have heard yet that the finger has moved: it is given time for that
  function rest(wait, event) {
    const due = performance.now() + wait;
    timer = setTimeout(() => {
      if (performance.now() > due + LATE) return rest(RESTS, event);
      if (held) ask("cancel", event);
      held = false;
      pressed = null;
      ask("menu", event);
    }, wait);
  }

  window.addEventListener("pointerdown", (event) => {
    if (passing || touches(event)) return;
    pressed = isOnPicture(event) ? [event.clientX, event.clientY] : null;
    if (event.button !== 0 || !pressed || !ask("down", event)) return;
    held = true;
    event.target.setPointerCapture(event.pointerId);
    take(event);
  }, true);

  window.addEventListener("pointermove", (event) => {
    if (pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) >= TREMBLES) clearTimeout(timer);
    if (!held && (event.buttons !== 0 || !isOnPicture(event))) return;
    const taken = ask("move", event);
    if (held) take(event);
    else event.target.style.cursor = taken ? "move" : "";
  }, true);

  window.addEventListener("pointerup", (event) => {
    clearTimeout(timer);
    const still = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < STILL;
    pressed = null;
    if (held) {
      held = false;
      ask("up", event);
      take(event);
    } else if (still && event.button === 0) ask("click", event);
    else if (still && event.button === 2) ask("menu", event);
  }, true);

  window.addEventListener("pointercancel", (event) => {
    clearTimeout(timer);
    held = false;
    ask("cancel", event);
  }, true);

  document.addEventListener("pointerleave", (event) => held || ask("leave", event));
  window.addEventListener("contextmenu", (event) => hand.ask && event.preventDefault(), true);

  window.__studioHand = hand;
})();
