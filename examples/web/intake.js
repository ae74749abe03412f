// SPDX-License-Identifier: BSL-1.0
// What was dropped: a list of files with what each of them is, and the table that asks for unknown columns.
const dropped = new Map(); // name -> what look or import answered, with the request that read it
let on_files = () => {};

const axes_of = names => `${names.length > 1 ? 'axes' : 'axis'} ${names.join(', ')}`;
const known_as = {
    log: f => `log: ${f.rows} rows, one every ${+(f.period_s * 1e3).toPrecision(4)}\u00a0ms, ${axes_of(f.axes.map(a => a.name))}`,
    machine: f => `machine file: ${axes_of(f.axes)}`,
    map: () => 'import map',
    table: () => 'a table whose columns have to be named below',
    unreadable: () => 'cannot be read',
};

function list_files() {
    the('dropped').replaceChildren(...[...dropped].map(([name, f]) => {
        const item = make('li', {className: f.error ? 'bad' : ''}, make('b', {textContent: name}), ' ', known_as[f.kind](f));
        for (const note of f.error ? [f.error].filter(() => f.kind !== 'table') : f.notes || []) item.append(make('small', {textContent: note}));
        return item;
    }));
}

const of_kind = kind => [...dropped].filter(([, f]) => f.kind === kind).map(([name]) => name);

async function read(name, request) {
    dropped.set(name, {...await call(request), request});
}

async function take(files) {
    for (const file of files) {
        let name = file.name;
        for (let k = 2; kept.has(name); ++k) name = `${k}-${file.name}`;
        await put(name, await file.arrayBuffer());
        await read(name, {do: 'look', file: name});
        list_files();
    }
    await use_map();
    list_files();
    ask_columns();
    on_files();
}

// A map that was dropped makes logs of the tables; one that joins several takes all of them.
async function use_map() {
    const map = of_kind('map').at(-1), tables = of_kind('table');
    if (!map || !tables.length) return;
    const joined = dropped.get(map).files;
    const groups = joined > 1 ? [tables.slice(0, joined)] : tables.map(t => [t]);
    for (const files of groups) await import_as(files, {map_file: map});
}

async function import_as(files, map) {
    const request = {do: 'import', files, ...map};
    const answer = await call(request);
    if (answer.error) {
        dropped.get(files[0]).error = answer.error;
        return answer.error;
    }
    dropped.set(files[0], {...answer, request});
    for (const name of files.slice(1)) dropped.delete(name);
}

// ---- columns by hand ----

function ask_columns() {
    const name = of_kind('table')[0];
    the('columns').hidden = !name;
    if (!name) return;
    const table = dropped.get(name);
    const by = table.tool
        ? `looks like a file of ${table.tool}. What its header says is filled in`
        : 'does not name its columns as our logs do (t_s, x_pos_m, ...). Position, command and time are needed; a reference if there is one. What the names say is filled in';
    the('columns-why').textContent = `${name} ${by}${table.open.length ? `; it does not say: ${table.open.join('; ')}` : ''}.`;
    const option = (value, text = value.replaceAll('_', ' ')) => make('option', {value, textContent: text});
    the('columns').querySelector('tbody').replaceChildren(...table.columns.map((c, k) => {
        const title = c.name || `column ${k + 1}`;
        const cell = (tag, what, properties = {}, ...children) => make('td', {}, (() => {
            const e = make(tag, properties, ...children);
            e.setAttribute('aria-label', `${what} of ${title}`);
            return e;
        })());
        const row = make('tr', {}, make('th', {scope: 'row', textContent: title}),
            cell('select', 'meaning', {}, option('', 'left out'), option('time'), ...table.roles.map(r => option(r)), option('measured', 'command, measured behind the amplifier')),
            cell('select', 'unit', {}, option('', '-'), ...table.units.map(u => option(u))),
            cell('input', 'axis', {type: 'text', value: c.axis, size: 4}));
        const [role, unit] = row.querySelectorAll('select');
        role.value = c.time ? 'time' : c.role;
        unit.value = c.unit;
        return row;
    }));
}

function map_by_hand(table) {
    const map = {schema: 'quadrant.import/1', ...table.layout, axes: {}};
    [...the('columns').querySelectorAll('tbody tr')].forEach((row, k) => {
        const [role, unit] = [...row.querySelectorAll('select')].map(s => s.value), axis = row.querySelector('input').value.trim();
        if (!role) return;
        const column = {column: table.columns[k].column, ...(unit ? {unit} : {})};
        if (role === 'time') map.time = column;
        else if (role === 'measured') (map.axes[axis] ||= {}).command = {...column, is: 'measured'};
        else (map.axes[axis] ||= {})[role] = column;
    });
    return map;
}

the('columns-use').addEventListener('click', async () => {
    const name = of_kind('table')[0];
    const fault = await import_as([name], {map: map_by_hand(dropped.get(name))});
    the('columns').querySelector('.fault').textContent = fault || '';
    list_files();
    if (!fault) { ask_columns(); on_files(); }
});

// ---- drop and choose ----

for (const [event, over] of [['dragover', true], ['dragleave', false], ['drop', false]])
    addEventListener(event, e => {
        e.preventDefault();
        the('drop').classList.toggle('over', over);
        if (event === 'drop') take(e.dataTransfer.files);
    });
the('files').addEventListener('change', e => take([...e.target.files]).then(() => { the('files').value = ''; }));
