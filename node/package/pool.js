// SPDX-License-Identifier: Apache-2.0
// Workers that answer one request each at a time. No imports, so that Node's CommonJS modules have it too (pack.mjs).

/// `start(listener)` starts a worker, { post(message), stop(), hold(isBusy) }, which calls listener.answer(reply) once
/// for each message, and listener.fail(error) when it has ended or no message can have the value. There are at most `most` workers; idle ones are kept. A
/// worker whose reply has `isSpent` is replaced.
export class Pool {
  constructor(start, most) {
    this.start = start, this.most = most;
    this.idle = [], this.queue = [], this.busy = new Map();
  }

  /// The reply to a message.
  ask(message) {
    return new Promise((done, fail) => {
      this.queue.push({ message, done, fail });
      this.next();
    });
  }

  next() {
    while (this.queue.length > 0 && (this.idle.length > 0 || this.busy.size < this.most)) {
      const worker = this.idle.pop() ?? this.open(), job = this.queue.shift();
      this.busy.set(worker, job);
      worker.hold(true);
      worker.post(job.message);
    }
  }

  open() {
    const worker = this.start({
      answer: (reply) => {
        const job = this.busy.get(worker);
        if (reply.isSpent) this.drop(worker);
        else this.release(worker);
        job?.done(reply);
        this.next();
      },
      fail: (error) => {
        const job = this.busy.get(worker);
        this.drop(worker);
        job?.fail(error);
        this.next();
      },
    });
    return worker;
  }

  release(worker) {
    this.busy.delete(worker);
    worker.hold(false);
    this.idle.push(worker);
  }

  drop(worker) {
    this.busy.delete(worker);
    this.idle = this.idle.filter((other) => other !== worker);
    worker.stop();
  }

  /// Ends all workers; requests without a reply fail.
  stop() {
    const jobs = [...this.queue, ...this.busy.values()];
    for (const worker of [...this.idle, ...this.busy.keys()]) worker.stop();
    this.idle = [], this.queue = [], this.busy = new Map();
    for (const { fail } of jobs) fail(new Error('the workers were closed'));
  }
}
