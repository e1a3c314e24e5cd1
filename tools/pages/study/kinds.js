// All that the page does for particular kinds of study. A kind that is not listed is shown with all its estimates and with samples in a
// plane.
study.kind = (() => {
  const { data } = study;
  const none = () => false, one = (...roles) => (f) => roles.includes(f.role);
  // title: of the study. isAnswer: selects the estimates shown at the top. plane: drawing of the samples, '' for none. isJudged: a remark
  // on any estimate makes it doubtful. isCounted: the treatment of failed runs is stated. beginsWithSentence: the first note is the answer
  // as a sentence. showsLaws: the variables' distributions are shown although samples do not follow them.
  const kinds = {
    sweep: { title: 'sweep', isAnswer: none, plane: 'sweep' },
    sample: { title: 'samples', isAnswer: (f) => f.role === 'probability' || f.quantity === 'mean', isCounted: true },
    reliability: { title: 'reliability', isAnswer: one('probability', 'beta'), isCounted: true, showsLaws: true },
    // Designs that change one variable at a time show nothing in a plane.
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
