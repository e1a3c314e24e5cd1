// Tables with three to four digits; all digits are in the title and in data-value. On a narrow screen each row becomes a card (page.css),
// whose lines are labelled by data-label.
steplap.tables = (() => {
  const make = steplap.make;
  const few = (value) => (value === null || value === undefined ? '–' : Number(value).toExponential(1).replace('-', '−'));

  // Creates a cell from a text, a node, or { text, value, full, class } for a number.
  function cellOf(name, content, isNumber, label) {
    const cell = make(name, isNumber ? { class: 'number' } : {});
    if (label) cell.setAttribute('data-label', label);
    if (content && content.text !== undefined && !(content instanceof Node)) {
      cell.append(content.text);
      if (content.value !== undefined && content.value !== null) cell.setAttribute('data-value', String(content.value));
      if (content.full) cell.title = content.full;
      if (content.class) cell.classList.add(content.class);
    } else cell.append(content === undefined || content === null ? '' : content);
    return cell;
  }
  // Creates a table. A row of a single text is the heading of the following rows.
  function table(heads, rows, numeric = []) {
    const element = make('table', { class: 'cards' }), isNumber = (i) => numeric.includes(i);
    if (heads) {
      const cells = heads.map((h, i) => {
        const th = cellOf('th', h, isNumber(i));
        th.scope = 'col';
        return th;
      });
      element.append(make('thead', {}, make('tr', {}, ...cells)));
    }
    const body = make('tbody');
    for (const row of rows) {
      if (typeof row === 'string') {
        body.append(make('tr', { class: 'group' }, make('th', { colspan: heads ? heads.length : 2, scope: 'colgroup' }, row)));
        continue;
      }
      const line = make('tr', {},
        ...row.map((c, i) => cellOf(i === 0 ? 'th' : 'td', c, isNumber(i),
                     i > 0 && heads ? String(heads[i] && heads[i].text !== undefined ? heads[i].text : heads[i] || '') : '')));
      line.firstChild.scope = 'row';
      body.append(line);
    }
    element.append(body);
    return make('div', { class: 'scroll', tabindex: '-1' }, element);
  }
  // Creates a section that the reader can open. `isOpen`: open initially.
  function fold(title, isOpen, ...content) {
    const box =
      make('details', isOpen ? { class: 'fold', open: '' } : { class: 'fold' }, make('summary', {}, make('h3', {}, title)), ...content);
    return box;
  }
  return { table, fold, few };
})();
