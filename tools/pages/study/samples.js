// The table of samples, and details of one sample with the command that repeats it.
study.samples = (() => {
  const { make, data } = study;
  const at = (id) => document.getElementById(id);
  const k_page = 50;
  const state = {
    order: Uint32Array.from({ length: data.shown }, (_, i) => i),
    page: 0,
    key: 'number',
    isDown: false,
    filter: 'all',
    chosen: -1
  };
  const kinds = ['', 'failure', 'failed-run'];

  // --- one sample ------------------------------------------------------------------------------------
  const quoted = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`);
  function command(i) {
    if (!data.about.models.length || data.about.variants.length) return '';
    return ['steplap', 'study', 'replay', data.about.file, '--sample', String(data.numbers[i]), '--store', data.store].map(quoted).join(
      ' ');
  }
  async function copy(text, button, code) {
    try {
      await navigator.clipboard.writeText(text);
    } catch (error) { // without access to the clipboard the text is selected
      getSelection().selectAllChildren(code);
      document.execCommand('copy');
    }
    button.textContent = 'Copied';
  }
  function commandLine(i) {
    const text = command(i);
    if (!text)
      return [make('p', { class: 'note' },
        data.about.variants.length ? 'A simplified model is another model, not other values of one: it cannot be replayed.'
          : data.about.models.length === 0 && data.about.file
          ? 'The study has no model: its samples are formulas of the values, there is no run to replay.'
          : 'The store does not say which study file it is of: run the study again to have the command that replays this sample.')];
    const code = make('code', {}, text), button = make('button', { type: 'button', class: 'copy' }, 'Copy');
    button.addEventListener('click', () => copy(text, button, code));
    return [
      make('p', { class: 'note' }, 'Runs it again, with its full report, in the folder the study was run in:'),
      make('div', { class: 'command' }, code, button)
    ];
  }
  // Shows the details of sample number i of the page.
  function show(i) {
    const box = at('sample'),
          roles = { variable: 'Values', response: 'Responses', border: 'Responses', 'limit state': 'Limit states', cost: 'The run' },
          fate = data.fate(i);
    const close = make('button', { type: 'button', class: 'close', 'aria-label': 'Close' }, '✕');
    close.addEventListener('click', () => {
      box.hidden = true;
      mark(-1);
    });
    const rows = [];
    for (const c of data.columns) {
      const isBroken = c.role === 'limit state' && c.values[i] < 0;
      rows.push([
        c.head, { text: c.text(i), class: isBroken ? 'doubt' : '' },
        isBroken                       ? { text: 'failure', class: 'doubt' }
          : roles[c.role] === 'Values' ? ''
          : c.role === 'cost'          ? 'of the run'
                                       : ''
      ]);
    }
    const status = data.statusOf(i), reason = data.reasonOf(i);
    box.replaceChildren(close, make('h3', {}, `Sample ${data.numbers[i]}`),
      make('p', fate ? { class: 'doubt' } : {},
        `Status: ${status}${reason ? `: ${reason}` : ''}${fate === 1 ? '; a limit state is broken' : ''}`),
      make('div', { class: 'scroll' }, study.table(null, rows, [1])), ...commandLine(i));
    box.hidden = false;
    mark(i);
  }
  function mark(i) {
    state.chosen = i;
    for (const row of document.querySelectorAll('#samples tbody tr')) row.classList.toggle('chosen', Number(row.dataset.place) === i);
  }
  // Returns a button that shows the sample with this number; its text only, if the page does not contain the sample.
  function button(number) {
    const i = data.numbers.indexOf(number);
    if (i < 0) return make('span', {}, String(number));
    const element = make('button', { type: 'button', class: 'plain' }, String(number));
    element.addEventListener('click', () => show(i));
    return element;
  }

  // --- the table -------------------------------------------------------------------------------------
  const keys = { number: (i) => data.numbers[i], status: (i) => data.status[i] };
  function arrange() {
    const wanted = { all: () => true, 'failed runs': (i) => data.fate(i) === 2, failures: (i) => data.fate(i) === 1 }[state.filter];
    const places = [];
    for (let i = 0; i < data.shown; ++i)
      if (wanted(i)) places.push(i);
    const column = data.columns.find((c) => `v ${c.name}` === state.key), of = column ? (i) => column.values[i] : keys[state.key],
          sign = state.isDown ? -1 : 1;
    // samples without a value come last in both sort orders
    places.sort((a, b) => {
      const x = of(a), y = of(b), no = Number.isNaN(x) - Number.isNaN(y);
      return no || (x < y ? -sign : x > y ? sign : 0) || a - b;
    });
    state.order = places;
    state.page = 0;
  }
  const pages = () => Math.max(1, Math.ceil(state.order.length / k_page));
  function head(text, key, isNumber) {
    const sort = make('button', { type: 'button', class: 'head' }, text);
    sort.addEventListener('click', () => {
      state.isDown = state.key === key && !state.isDown;
      state.key = key;
      arrange();
      build();
    });
    const th = make('th', {
      scope: 'col',
      'aria-sort': state.key === key ? (state.isDown ? 'descending' : 'ascending') : 'none',
      ...(isNumber ? { class: 'number' } : {})
    },
      sort);
    return th;
  }
  function build() {
    const first = state.page * k_page, rows = state.order.slice(first, first + k_page);
    const heads =
      [head('sample', 'number', true), head('status', 'status', false), ...data.columns.map((c) => head(c.head, `v ${c.name}`, true))];
    const body = rows.map((i) => {
      const row = make('tr', { 'data-place': String(i), class: `${kinds[data.fate(i)]}${i === state.chosen ? ' chosen' : ''}` },
        make('th', { class: 'number', scope: 'row' }, button(data.numbers[i])),
        make('td', { class: 'fate', title: data.reasonOf(i) }, data.fate(i) === 1 ? 'failure' : data.statusOf(i)),
        ...data.columns.map((c) => make('td', { class: 'number' }, c.text(i))));
      row.addEventListener('click', (event) => {
        if (event.target.tagName !== 'BUTTON') show(i);
      });
      return row;
    });
    const table = make('table', {}, make('thead', {}, make('tr', {}, ...heads)), make('tbody', {}, ...body));
    at('sample-table').replaceChildren(table);
    at('sample-place').textContent = state.order.length
      ? `${first + 1} to ${first + rows.length} of ${state.order.length}${state.filter === 'all' ? '' : ` ${state.filter}`}, page ${
          state.page + 1} of ${pages()}`
      : 'none';
  }
  function draw() {
    const go = (label, text, where) => {
      const element = make('button', { type: 'button', 'aria-label': label, title: label }, text);
      element.addEventListener('click', () => {
        state.page = Math.max(0, Math.min(pages() - 1, where()));
        build();
      });
      return element;
    };
    const filter = make('select', { id: 'sample-filter' }, ...['all', 'failures', 'failed runs'].map((text) => make('option', {}, text)));
    filter.addEventListener('change', () => {
      state.filter = filter.value;
      arrange();
      build();
    });
    at('samples').append(make('p', { class: 'note', id: 'samples-shown' }, data.shownText()),
      make('div', { class: 'controls pager' }, make('label', {}, 'Show ', filter), go('first page', '«', () => 0),
        go('page before', '‹', () => state.page - 1), go('next page', '›', () => state.page + 1), go('last page', '»', () => pages() - 1),
        make('output', { id: 'sample-place' })),
      make('div', { id: 'sample-table', class: 'scroll' }),
      make('p', { class: 'note' },
        'A click on a row shows the sample; on a heading sorts by it. Six digits are written: steplap study export writes all.'));
    arrange();
    build();
  }
  return { draw, show, button, command };
})();
