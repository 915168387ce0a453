// Pointers over the panes: they move, enlarge and divide the images, and choose the inspected pixel.

/// Listens to the pointers of `stage.room`.
export class Pointer {
  constructor(stage) {
    this.stage = stage;
    this.pressed = new Map(); // by the pointer's id: its last position, its pane, and whether it holds the slider's handle
    const handlers = { pointerdown: this.press, pointermove: this.move, pointerup: this.release, pointercancel: this.release, dblclick: this.enlarge };
    for (const [name, handler] of Object.entries(handlers)) stage.room.addEventListener(name, handler.bind(this));
    stage.room.addEventListener('wheel', (event) => this.turn(event), { passive: false });
  }

  paneOf({ target }) { return this.stage.panes.find((pane) => target === pane.canvas || target === this.stage.handle); }

  press(event) {
    const pane = this.paneOf(event), isHandle = event.target === this.stage.handle;
    if (!pane || event.button !== 0) return;
    this.stage.room.setPointerCapture(event.pointerId);
    this.pressed.set(event.pointerId, { x: event.clientX, y: event.clientY, pane, isHandle });
    if (!isHandle) this.stage.room.focus({ preventScroll: true });
  }

  release(event) { this.pressed.delete(event.pointerId); }

  move(event) {
    const own = this.pressed.get(event.pointerId), { stage } = this;
    if (!own) return this.inspect(event);
    const dx = event.clientX - own.x, dy = event.clientY - own.y;
    own.x = event.clientX, own.y = event.clientY;
    if (own.isHandle) return stage.set({ split: Math.min(1, Math.max(0, own.pane.placeOf(event).x / stage.pane.width)) });
    const other = [...this.pressed.values()].find((pointer) => pointer !== own);
    if (!other) return stage.moveBy(dx, dy);
    const distance = Math.hypot(own.x - other.x, own.y - other.y), before = Math.hypot(own.x - dx - other.x, own.y - dy - other.y);
    if (before > 0) stage.zoomTo(Math.min(64, Math.max(1 / 8, stage.view.zoom * distance / before)), own.pane.placeOf(event));
    return undefined;
  }

  inspect(event) {
    const pane = this.paneOf(event), { stage } = this;
    if (!pane) return;
    const pixel = stage.view.pixelAt(pane.placeOf(event), pane.imageSize, pane.size);
    if (pixel && (pixel.x !== stage.pixel?.x || pixel.y !== stage.pixel?.y)) stage.set({ pixel: { ...pixel, ...pane.imageSize } });
  }

  turn(event) {
    const pane = this.paneOf(event), { stage } = this;
    if (!pane || event.deltaY === 0 || event.shiftKey) return;
    // The whole image is the smallest that is useful: below it the page scrolls.
    if (stage.view.isFitted && event.deltaY > 0) return;
    event.preventDefault();
    stage.zoomBy(event.deltaY < 0 ? 1 : -1, pane.placeOf(event));
  }

  enlarge(event) {
    const pane = this.paneOf(event), { stage } = this;
    if (!pane || event.target === stage.handle) return;
    if (stage.view.isFitted) stage.zoomTo(Math.max(8, stage.view.next(1)), pane.placeOf(event));
    else stage.fit();
  }
}
