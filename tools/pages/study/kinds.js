// Properties of study kinds that affect the page. A kind that is not listed shows all its estimates, and its samples in a plane.
study.kind = (() => {
  const { data } = study;
  const none = () => false, one = (...roles) => (f) => roles.includes(f.role);
  // title: heading of the page. isAnswer: selects the estimates shown at the top. plane: diagram of the samples, '' for none. isJudged: a
  // remark on any estimate makes it doubtful. isCounted: the treatment of failed runs is stated. beginsWithSentence: the first note is the
  // answer as a sentence. showsLaws: distributions of variables are shown although samples do not follow them.
  const kinds = {
    sweep: { title: 'sweep', isAnswer: none, plane: 'sweep' },
    sample: { title: 'samples', isAnswer: (f) => f.role === 'probability' || f.quantity === 'mean', isCounted: true },
    reliability: { title: 'reliability', isAnswer: one('probability', 'beta'), isCounted: true, showsLaws: true },
    // Samples of designs that change one variable at a time are not shown in a plane.
    sensitivity:
      { title: 'sensitivity', isAnswer: none, plane: ['tornado', 'elasticity'].includes(data.about.settings.method) ? '' : 'scatter' },
    critical: { title: 'critical values', isAnswer: one('critical'), plane: 'critical' },
    design: { title: 'design', isAnswer: one('holds from', 'holds to'), plane: 'design', isJudged: false, beginsWithSentence: true },
    map: { title: 'map', isAnswer: none, plane: 'map' },
    needs: { title: 'what the scene needs', isAnswer: none, plane: '' },
    fit: { title: 'fit', isJudged: true }
  };
  return {
    title: data.kind,
    isAnswer: () => true,
    plane: 'scatter',
    isJudged: false,
    isCounted: false,
    showsLaws: false,
    beginsWithSentence: false,
    ...(Object.hasOwn(kinds, data.kind) ? kinds[data.kind] : {})
  };
})();
