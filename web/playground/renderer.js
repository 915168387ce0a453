// A renderer in a worker.

/// The number of threads of a renderer: those of the machine, where the page is cross-origin isolated. Pages have two
/// renderers, which often work one after the other.
export const mostThreads = globalThis.crossOriginIsolated ? Math.min(navigator.hardwareConcurrency, 16) : 1;

export class Renderer {
  constructor(threads = mostThreads) {
    this.worker = new Worker(new URL(`./worker.js?threads=${threads}`, import.meta.url), { type: 'module' });
    this.waiting = new Map(), this.count = 0;
    this.worker.onmessage = ({ data: { id, result, error } }) => {
      const { done, fail } = this.waiting.get(id);
      this.waiting.delete(id);
      if (error) fail(new Error(error));
      else done(result);
    };
    this.worker.onerror = (event) => {
      for (const { fail } of this.waiting.values()) fail(new Error(event.message || 'the renderer could not be loaded'));
      this.waiting.clear();
    };
  }

  /// The result of a request of worker.js. Requests are answered in order.
  ask(name, ...args) {
    const id = ++this.count;
    this.worker.postMessage({ id, name, args });
    return new Promise((done, fail) => this.waiting.set(id, { done, fail }));
  }
}
