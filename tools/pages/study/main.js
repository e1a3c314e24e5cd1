// Builds the page of a study from top to bottom.
(() => {
  const { make, data } = study, at = (id) => document.getElementById(id);
  const title = data.about.title || data.about.file || data.store;
  document.title = `steplap: ${title}`;
  at('title').textContent = title;
  at('subtitle').textContent = [
    `Study: ${study.kind.title}`, ...(data.about.models.length ? [`of ${data.about.models.join(', ')}`] : []),
    `${data.samples.total} samples`, `steplap ${data.version}`
  ].join(' · ');
  if (!data.about.numbers.length && !data.about.variables.length)
    at('subtitle').append(' · The store was made before units were kept in it: numbers are in SI. Run the study again to have them.');
  study.estimates.answer();
  study.estimates.influence();
  study.estimates.designPoints();
  study.estimates.indices();
  study.estimates.needs();
  study.estimates.fit();
  study.planes.draw();
  study.estimates.convergence();
  study.distributions.draw();
  study.estimates.variables();
  study.estimates.everything();
  study.samples.draw();
  for (const [name, text] of [['The study file, with what it extends', data.study_text],
         ['The models as they were run, and what is looked at', data.scene_text]])
    if (text) at('texts').append(make('details', {}, make('summary', {}, name), make('pre', {}, text)));
  at('footer').textContent = `Written by ${data.program} from ${
    data.store}. Charts by Plotly, © Plotly Technologies Inc., MIT licence (text at the end of this file's source).`;
  document.addEventListener('keydown', (event) => {
    if (event.key === 'Escape') at('sample').hidden = true;
  });
  queueMicrotask(() => document.body.setAttribute('data-ready', 'true')); // set after the charts are drawn, for tests
})();
