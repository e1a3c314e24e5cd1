// Picture of the machine at the worst instant of an event, computed by the model with the worst verdict and seen from the body that carries
// the recorder.
steplap.eventMachine = (() => {
  const A = steplap.assessment;
  const isPose = (pose) => Array.isArray(pose) && pose.length === 3 && pose.every(Number.isFinite);
  // Returns the result with the worst verdict among the models of an event that have poses and a drawing; the first one of equals.
  function gravest(e) {
    const isDrawn = (m) => A.models.some((model) => model.name === m.model && model.drawing);
    const known = e.models.filter((m) => isDrawn(m) && Object.values(m.poses || {}).some(isPose));
    return known.sort((a, b) => A.rankOf(a.verdict) - A.rankOf(b.verdict))[0] || null;
  }
  // Returns { picture, text } for an event; null if no model has poses.
  function of (e, columns) {
    const said = gravest(e);
    if (!said) return null;
    const { drawing, recorder } = A.models.find((model) => model.name === said.model);
    const run = steplap.data.still(said.model, drawing), moved = [...said.slipping, ...said.lifted];
    run.poseOf = (name) => (isPose(said.poses[name]) ? said.poses[name] : null);
    run.events = said.slipping.map((name) => [0, name, 'slips', '', 'slip']);
    run.summary = {...run.summary, overview: { moved, story: [], utilisations: [], reason: '', verdict: said.verdict } };
    const seenFrom = recorder && run.drawing.bodies.some((b) => b.name === recorder.body) ? recorder.body : 'ground';
    const at = Number.isFinite(said.worst_time) ? ` at ${steplap.numbers.one(said.worst_time, 's')} of the record` : '';
    const text = `Event ${e.number}${at}: ${said.model} where a limit is nearest.`;
    return { picture: steplap.sheet.drawing(run, 0, columns, seenFrom), text };
  }
  return { of };
})();
