// SPDX-License-Identifier: Apache-2.0
// Mouse, touch, pen and keys on the picture, turned into movements in the units of camera.js. Left drag or one finger
// orbits; wheel, pinch or middle drag zooms to the cursor; right drag, a drag with Ctrl, Cmd or Shift, or two fingers
// pan. Arrow keys pan, with Shift they orbit; + and - zoom; R or Home goes back.

const kLinePx = 16;          // a wheel that counts lines, as Firefox' does
const kPagePx = 400;
const kZoomPerPx = 0.0011;   // of the wheel; one notch of 100 pixels is a tenth
const kPinchPerPx = 0.01;    // browsers tell the logarithm of a trackpad's pinch in hundredths
const kMostPinchPx = 40;     // in one event; most wheels' notches are larger; a held Ctrl key is checked as well
const kDragZoomPerPx = 0.006;
const kKeyPan = 0.06;        // picture heights a key press
const kKeyOrbit = Math.PI / 24;
const kKeyZoom = 0.16;

const kArrows = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

// `move({azimuth, polar, panX, panY, zoomLog}, cursor)` gets every movement, `reset()` the wish to go back.
export function attachGestures(element, { move, reset }) {
  const pointers = new Map();  // id -> {x, y, action} of what touches the picture
  const isControlHeld = watchControlKey();

  const cursorAt = (x, y) => {
    const box = element.getBoundingClientRect();
    return { x: (x - box.left - box.width / 2) / box.height, y: (box.height / 2 - (y - box.top)) / box.height };
  };
  const height = () => element.clientHeight || 1;

  const drag = (action, dx, dy, cursor) => {
    const fx = dx / height();
    const fy = dy / height();
    if (action === 'orbit') move({ azimuth: 2 * Math.PI * fx, polar: 2 * Math.PI * fy });
    if (action === 'pan') move({ panX: fx, panY: fy });
    if (action === 'zoom') move({ zoomLog: -dy * kDragZoomPerPx }, cursor);
  };

  const pinch = (id, x, y) => {
    const [a, b] = [...pointers.values()];
    const before = spread(a, b);
    Object.assign(pointers.get(id), { x, y });
    const after = spread(a, b);
    move({ panX: (after.x - before.x) / height(), panY: (after.y - before.y) / height() });
    if (before.size > 0 && after.size > 0) move({ zoomLog: Math.log(after.size / before.size) }, cursorAt(after.x, after.y));
  };

  element.addEventListener('pointerdown', (event) => {
    element.setPointerCapture(event.pointerId);
    const origin = cursorAt(event.clientX, event.clientY);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, action: actionOf(event), origin });
  });

  element.addEventListener('pointermove', (event) => {
    const pointer = pointers.get(event.pointerId);
    if (!pointer) return;
    if (pointers.size === 2) {
      pinch(event.pointerId, event.clientX, event.clientY);
      return;
    }
    if (pointers.size === 1) drag(pointer.action, event.clientX - pointer.x, event.clientY - pointer.y, pointer.origin);
    Object.assign(pointer, { x: event.clientX, y: event.clientY });
  });

  const release = (event) => pointers.delete(event.pointerId);
  element.addEventListener('pointerup', release);
  element.addEventListener('pointercancel', release);
  element.addEventListener('lostpointercapture', release);
  element.addEventListener('contextmenu', (event) => event.preventDefault());

  element.addEventListener('wheel', (event) => {
    event.preventDefault();
    const px = event.deltaY * ([1, kLinePx, kPagePx][event.deltaMode] ?? 1);
    const isPinch = event.ctrlKey && !isControlHeld() && Math.abs(px) < kMostPinchPx;
    move({ zoomLog: -px * (isPinch ? kPinchPerPx : kZoomPerPx) }, cursorAt(event.clientX, event.clientY));
  }, { passive: false });

  element.addEventListener('keydown', (event) => {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    if (pressed(event)) event.preventDefault();
  });

  const pressed = (event) => {
    const arrow = kArrows[event.key];
    if (arrow && event.shiftKey) move({ azimuth: arrow[0] * kKeyOrbit, polar: arrow[1] * kKeyOrbit });
    else if (arrow) move({ panX: arrow[0] * kKeyPan, panY: arrow[1] * kKeyPan });
    else if (event.key === '+' || event.key === '=') move({ zoomLog: kKeyZoom });
    else if (event.key === '-') move({ zoomLog: -kKeyZoom });
    else if (event.key === 'Home' || event.key.toLowerCase() === 'r') reset();
    else return false;
    return true;
  };
}

// Whether a Ctrl key is held. A wheel event cannot tell: a trackpad's pinch comes as a wheel with Ctrl that nobody pressed.
// A key that was pressed elsewhere is known by the next movement of the pointer.
function watchControlKey() {
  let isHeld = false;
  const listen = (type, read) => addEventListener(type, read, { capture: true, passive: true });
  for (const type of ['keydown', 'keyup']) {
    listen(type, (event) => { isHeld = event.key === 'Control' ? type === 'keydown' : event.ctrlKey; });
  }
  for (const type of ['pointerdown', 'pointermove']) listen(type, (event) => { isHeld = event.ctrlKey; });
  listen('blur', () => { isHeld = false; });
  return () => isHeld;
}

function actionOf(event) {
  const modified = event.ctrlKey || event.metaKey || event.shiftKey;
  if (event.button === 1) return 'zoom';
  return (event.button === 2) !== modified ? 'pan' : 'orbit';
}

function spread(a, b) {
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.hypot(a.x - b.x, a.y - b.y) };
}
