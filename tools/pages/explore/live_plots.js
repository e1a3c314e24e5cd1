// Curves of the old and the new state in one figure, redrawn while a slider is dragged. Visible figures are redrawn at once, others when
// they become visible.
steplap.LivePlots = class LivePlots extends steplap.Plots {
  constructor(grid, onTime) {
    super(grid, onTime);
    this.layout = 'overlaid';
    this.inView = new Set();
    this.late = new Set();
    this.watcher = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const plot = this.plots.find((p) => p.box === target);
        if (!plot) continue;
        if (!isIntersecting) this.inView.delete(plot);
        else {
          this.inView.add(plot);
          if (this.late.delete(plot)) plot.refresh();
        }
      }
    });
  }
  build() {
    this.watcher?.disconnect();
    this.inView?.clear();
    this.late?.clear();
    super.build();
    for (const plot of this.plots) this.watcher.observe(plot.box);
  }
  // Releases the figures before this object is replaced.
  end() {
    this.watcher.disconnect();
    for (const plot of this.plots)
      if (plot.graph) plot.graph.destroy();
  }
  // Sets the two runs to be drawn. Rebuilds the figures if their channels differ.
  setRuns(from, to) {
    const runs = steplap.data.runs, full = [0, Math.max(...runs.map((r) => r.end))];
    const isWhole = this.window[0] === this.full[0] && this.window[1] === this.full[1], isSame = full[1] === this.full[1];
    this.full = full;
    if (isWhole || !isSame) this.window = full;
    if (!from || !this.plots.length || !this.plots.every((plot) => plot.replaceRun(from, to))) return this.renew();
    for (const plot of this.plots)
      if (this.inView.has(plot)) plot.refresh();
      else this.late.add(plot);
  }
  renew() {
    this.figures = steplap.figures.of(steplap.data.runs);
    this.build();
  }
  // Returns true if the runs require other figures than those shown, which are kept while a slider is dragged.
  get isOutdated() {
    const name = (f) => `${f.name}\n${f.channels.join()}`;
    return steplap.figures.of(steplap.data.runs).map(name).join('\n') !== this.figures.map(name).join('\n');
  }
};
