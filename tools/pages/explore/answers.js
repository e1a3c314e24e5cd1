// Sends requests of the page to its server. Only one run is in progress at a time; the next request has the newest values. Intermediate
// values may be skipped, but the last ones are always computed.
steplap.Answers = class Answers {
  constructor(onAnswer, onSilence) {
    Object.assign(this,
      { onAnswer, onSilence, page: Math.random().toString(36).slice(2), last: 0, shown: 0, wanted: null, underway: new Set(), sentAt: 0 });
  }
  // ms; if a run takes longer, newer values are sent, and the server aborts the run
  static get patience() { return 150; }
  async post(path, body) {
    const reply = await fetch(path, {
      method: 'POST',
      headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify(body),
      credentials: 'omit',
      redirect: 'error'
    });
    if (!reply.ok) throw new Error(await reply.text());
    return reply.json();
  }
  async state(since) {
    const reply = await fetch(`state?since=${since}`, { credentials: 'omit', redirect: 'error' });
    if (!reply.ok) throw new Error(await reply.text());
    return reply.json();
  }
  // Requests a run. `request`: { model, values, is_settled }. `since`: time of the user's action, ms, from performance.now().
  want(request, since = performance.now()) {
    this.wanted = { request, since, number: ++this.last };
    this.next();
  }
  get isIdle() { return !this.wanted && !this.underway.size; }
  next() {
    if (!this.wanted || this.underway.size > 1) return;
    const age = performance.now() - this.sentAt;
    if (this.underway.size && age < Answers.patience) {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.next(), Answers.patience - age + 1);
      return;
    }
    const asked = this.wanted;
    this.wanted = null;
    this.underway.add(asked);
    this.sentAt = performance.now();
    this.post('run', {...asked.request, page: this.page })
      .then(
        (answer) => {
          this.underway.delete(asked);
          if (!answer.is_superseded && asked.number > this.shown) {
            this.shown = asked.number;
            this.onAnswer(answer, asked);
          }
        },
        (error) => {
          this.underway.delete(asked);
          this.onSilence(error);
        })
      .finally(() => this.next());
  }
};
