// SPDX-License-Identifier: BSL-1.0
// The questions of `quadrant-gap init`, for a log without a machine file.
const form = the('machine').querySelector('form');
let form_log = '', begun = null; // the machine file so far, or null

function form_values() {
    const values = {};
    for (const input of form.querySelectorAll('input[data-option]'))
        if (input.value.trim() !== '' && Number.isFinite(input.valueAsNumber))
            (values[input.dataset.option] ||= {})[input.dataset.axis] = input.valueAsNumber;
    return values;
}

async function ask_machine() {
    const answer = await call({do: 'form', log: form_log, values: form_values(), measured: form.elements.measured?.checked || false});
    if (answer.error) { begun = null; the('machine').querySelector('.fault').textContent = answer.error.replace(/^init: /, ''); return; }
    if (!form.childElementCount) lay_out(answer.fields);
    for (const input of form.querySelectorAll('input[data-option]')) {
        const found = answer.found?.[input.dataset.option]?.[input.dataset.axis];
        input.placeholder = found === undefined ? '' : String(+found.toPrecision(4));
    }
    begun = answer.ready ? answer.machine : null;
    the('machine').querySelector('.fault').textContent = answer.message || '';
    follow_choice();
}

function lay_out(fields) {
    const axes = dropped.get(form_log).axes.map(a => a.name);
    const field = f => axes.map(axis => make('label', {},
        make('b', {textContent: `${f.name}${axes.length > 1 ? ` of ${axis}` : ''}`}), `: ${f.label}${f.unit ? ` [${f.unit}]` : ''}`,
        (() => { const i = make('input', {type: 'number', step: 'any'}); Object.assign(i.dataset, {option: f.option, axis}); return i; })()));
    const group = (title, list) => make('fieldset', {}, make('legend', {textContent: title}), make('div', {className: 'fields'}, ...list.flatMap(field)));
    const often = fields.filter(f => f.often);
    form.append(group('Axis', often.filter(f => f.box !== 'controller')), group('Controller', often.filter(f => f.box === 'controller')),
        make('details', {}, make('summary', {textContent: 'More'}), group('More', fields.filter(f => !f.often))),
        make('label', {className: 'tick'}, make('input', {type: 'checkbox', name: 'measured'}), ' the command was measured behind the amplifier'));
}

function show_form(log) {
    the('machine').hidden = !log;
    if (log === form_log) return;
    form_log = log;
    form.replaceChildren();
    if (log) ask_machine();
}

form.addEventListener('change', ask_machine);
form.addEventListener('submit', e => e.preventDefault());
