// Page with a single sheet, whose kind depends on the results in the page.
(() => {
  const { loadCases, runs } = steplap.data, { given, statics } = steplap.assessment;
  const sheet = given || statics.length ? steplap.assessmentSheet() : loadCases ? steplap.casesSheet(loadCases) : steplap.runSheet(runs[0]);
  steplap.page = { kept: steplap.sheet.fit(sheet.contentOf, sheet.room) };
  document.body.setAttribute('data-ready', 'true');
})();
