// The transform that all panes share: a zoom, and the position of the image that is in the middle of each pane.

export const zooms = [1 / 8, 1 / 4, 1 / 2, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64];

/// Zoom in CSS pixels per pixel of the image; the position in the middle as fractions of the image's size, so that images
/// of different sizes are linked too.
export class View {
  zoom = 1;
  middle = { x: 0.5, y: 0.5 };
  isFitted = true;

  /// The greatest zoom at which the whole image is visible: an integer, or less than 1.
  static fitting(image, pane) {
    const zoom = Math.min(pane.width / image.width, pane.height / image.height);
    return Math.min(64, zoom >= 1 ? Math.floor(zoom + 1e-6) : zoom);
  }

  fit(image, pane) {
    this.zoom = View.fitting(image, pane);
    this.middle = { x: 0.5, y: 0.5 };
    this.isFitted = true;
  }

  /// The position of the image's corner in the pane, in CSS pixels.
  origin(image, pane) {
    return {
      x: pane.width / 2 - this.middle.x * image.width * this.zoom,
      y: pane.height / 2 - this.middle.y * image.height * this.zoom,
    };
  }

  /// Keeps the image in the pane: an image that is smaller than the pane stays in the middle.
  clamp(image, pane) {
    const inside = (fraction, size, room) => {
      const half = room / 2 / (size * this.zoom);
      return half >= 0.5 ? 0.5 : Math.min(1 - half, Math.max(half, fraction));
    };
    this.middle.x = inside(this.middle.x, image.width, pane.width);
    this.middle.y = inside(this.middle.y, image.height, pane.height);
  }

  /// Moves the images by CSS pixels.
  move(dx, dy, image, pane) {
    this.middle.x -= dx / (image.width * this.zoom);
    this.middle.y -= dy / (image.height * this.zoom);
    this.isFitted = false;
    this.clamp(image, pane);
  }

  /// Zooms so that the position of the image at `at`, in CSS pixels of the pane, stays there.
  zoomTo(zoom, at, image, pane) {
    const before = this.origin(image, pane), ratio = zoom / this.zoom;
    this.zoom = zoom;
    this.isFitted = false;
    this.middle.x = (pane.width / 2 - (at.x - (at.x - before.x) * ratio)) / (image.width * zoom);
    this.middle.y = (pane.height / 2 - (at.y - (at.y - before.y) * ratio)) / (image.height * zoom);
    this.clamp(image, pane);
  }

  /// The next greater (+1) or smaller (-1) zoom of the list.
  next(direction) {
    const near = 1e-6;
    if (direction > 0) return zooms.find((zoom) => zoom > this.zoom + near) ?? this.zoom;
    return zooms.findLast((zoom) => zoom < this.zoom - near) ?? this.zoom;
  }

  /// The pixel at a position of the pane; null outside of the image.
  pixelAt(at, image, pane) {
    const { x, y } = this.origin(image, pane);
    const pixel = { x: Math.floor((at.x - x) / this.zoom), y: Math.floor((at.y - y) / this.zoom) };
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x < image.width && pixel.y < image.height ? pixel : null;
  }
}

/// The rectangle of pixels that is visible and its place, in device pixels.
export function visiblePart(view, image, pane, ratio) {
  const { x, y } = view.origin(image, pane), scale = view.zoom * ratio;
  const left = Math.round(x * ratio), top = Math.round(y * ratio);
  const from = { x: Math.max(0, Math.floor(-left / scale)), y: Math.max(0, Math.floor(-top / scale)) };
  const to = {
    x: Math.min(image.width, Math.ceil((pane.width * ratio - left) / scale)),
    y: Math.min(image.height, Math.ceil((pane.height * ratio - top) / scale)),
  };
  return { left, top, scale, from, to };
}
