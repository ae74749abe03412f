// SPDX-License-Identifier: BSL-1.0
// Sliders for what was found; gap and curves of the simulation with their values.
const wanted = () => ({
    causes: [...the('knobs').querySelectorAll('.knob.of-cause')].map(knob => ({
        on: knob.querySelector('input[type=checkbox]').checked,
        values: [...knob.querySelectorAll('input[type=range]')].map(s => Number(s.value)),
    })),
    calibrated: the('calibrated')?.checked ?? true,
});
let found = null, shown = null, gains = null, at_work = false, again = false;

const in_digits = v => v === 0 ? '0' : String(+v.toPrecision(4));

function lay_out_knobs({causes, has_calibration}) {
    const knobs = causes.map((c, k) => {
        const tick = make('input', {type: 'checkbox', checked: c.claimed, disabled: !c.sliders.length, id: `cause-${k}`});
        const knob = make('div', {className: 'knob of-cause'}, make('label', {}, tick, ` ${c.label}, axis ${c.axis}`),
            make('small', {textContent: ` ${c.claimed ? 'claimed' : 'a suspect'}, ${c.probability.replace(' ', '\u00a0')}${c.sliders.length ? '' : '; it has no value to set'}`}));
        c.sliders.forEach((s, i) => {
            const id = `value-${k}-${i}`, say = make('output');
            const range = make('input', {type: 'range', id, min: s.low, max: s.high, step: 'any'});
            const tell = () => {
                say.textContent = `${in_digits(range.value * s.factor)} ${s.unit}`;
                range.setAttribute('aria-valuetext', say.textContent);
            };
            range.value = s.value;
            range.addEventListener('input', tell);
            tell();
            say.htmlFor = id;
            knob.append(make('div', {className: 'slide'}, make('label', {htmlFor: id, textContent: s.label}), range, say));
        });
        return knob;
    });
    if (has_calibration)
        knobs.push(make('div', {className: 'knob'}, make('label', {}, make('input', {type: 'checkbox', id: 'calibrated', checked: true}),
            ' Calibration'), make('small', {textContent: ' values moved within the tolerances of the machine file'})));
    the('knobs').replaceChildren(...knobs);
}

function gap_table(title, before, after) {
    const rows = before.flatMap((axis, k) => axis.gap.map(([name, was], r) => make('tr', {},
        make('th', {scope: 'row', textContent: before.length > 1 ? `${axis.axis}: ${name}` : name}),
        make('td', {className: 'was', textContent: was}), make('td', {className: 'now', textContent: after[k].gap[r]?.[1] ?? ''}))));
    const titles = ['Gap', 'machine file', 'with these'].map(textContent => make('th', {scope: 'col', textContent}));
    return [make('h3', {textContent: title}),
        make('table', {}, make('thead', {}, make('tr', {}, ...titles)), make('tbody', {}, ...rows))];
}

const tint = name => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();

// The scale of the machine file's curve, so that it stays while sliders move: where its largest value is far beyond
// nearly all others, the curve shows those. Second: how far anything goes beyond the scale, or 0.
function scale_of(before, after) {
    const sizes = before.flat().map(Math.abs).sort((a, b) => a - b), usual = sizes[Math.floor(0.995 * (sizes.length - 1))];
    const size = Math.max(sizes.at(-1) > 2.5 * usual && usual > 0 ? 1.3 * usual : sizes.at(-1), 1e-300);
    const most = [...sizes.slice(-1), ...after.flat()].reduce((a, v) => Math.max(a, Math.abs(v)), 0);
    return [size, most > 1.001 * size ? most : 0];
}

function draw_curve(canvas, unit, seconds, before, after) {
    const w = canvas.clientWidth, h = canvas.clientHeight, dpr = devicePixelRatio || 1, pen = canvas.getContext('2d');
    Object.assign(canvas, {width: w * dpr, height: h * dpr});
    pen.scale(dpr, dpr);
    const [size, beyond] = scale_of(before, after);
    const [factor, prefix] = [[1, ''], [1e3, 'm'], [1e6, 'µ'], [1e9, 'n']].find(([f]) => size * f >= 1) || [1e9, 'n'];
    const left = 74, bottom = h - 20, y = v => 6 + (bottom - 6) * (1 - (Math.max(-1, Math.min(1, v / size)) + 1) / 2);
    pen.font = '12px ' + getComputedStyle(document.body).fontFamily;
    pen.fillStyle = tint('muted');
    pen.strokeStyle = tint('grid');
    pen.textAlign = 'right';
    for (const part of [-1, 0, 1]) {
        pen.fillText(part ? `${in_digits(part * size * factor)} ${prefix}${unit}` : '0', left - 6, y(part * size) + (part > 0 ? 8 : part < 0 ? 0 : 4));
        pen.beginPath();
        pen.moveTo(left, y(part * size));
        pen.lineTo(w, y(part * size));
        pen.stroke();
    }
    pen.fillText(`${in_digits(seconds)} s`, w, h - 4);
    pen.textAlign = 'left';
    pen.fillText('0 s', left, h - 4);
    if (beyond) {
        pen.textAlign = 'center';
        pen.fillText(`spikes up to ${in_digits(beyond * factor)} ${prefix}${unit} go beyond the curve`, (left + w) / 2, h - 4);
        pen.textAlign = 'left';
    }
    for (const [[low, high], name] of [[before, 'before'], [after, 'after']]) {
        pen.strokeStyle = tint(name);
        pen.lineWidth = Math.max(1, (w - left) / low.length);
        pen.beginPath();
        low.forEach((v, k) => {
            const x = left + (k + 0.5) / low.length * (w - left);
            pen.moveTo(x, y(v) + 0.5);
            pen.lineTo(x, y(high[k]) - 0.5);
        });
        pen.stroke();
    }
}

function draw_what_if() {
    if (!shown) return;
    const canvases = the('curves').querySelectorAll('canvas');
    let next = 0;
    found.before.forEach((axis, k) => axis.charts.forEach((chart, c) =>
        draw_curve(canvases[next++], chart.unit, axis.seconds, chart.lines, shown.after[k].charts[c].lines)));
}

async function compute_what_if() {
    if (at_work) { again = true; return; }
    at_work = true;
    for (const knob of the('knobs').querySelectorAll('.knob')) knob.classList.toggle('off', !knob.querySelector('input').checked);
    const began = performance.now(), answer = await call({do: 'what_if', ...wanted()});
    at_work = false;
    if (answer.cancelled) return;
    the('what-if').querySelector('.fault').textContent = answer.error || '';
    if (!answer.error) {
        shown = answer;
        the('gaps').replaceChildren(...gap_table('On the log', found.before, answer.after),
            ...(answer.after_holdout ? gap_table('Forecast of the hold-out log', found.before_holdout, answer.after_holdout) : []));
        draw_what_if();
        the('took').textContent = `Computed in ${Math.round(performance.now() - began)} ms.`;
    }
    if (again) { again = false; compute_what_if(); }
    else if (!answer.error) compute_compensation();
}

// ---- what a compensation in the controller would gain ----

function gains_of(axis, several) {
    const title = several ? `Tracking error of axis ${axis.axis}` : 'Tracking error';
    const titles = ['', 'rms', 'peak', 'at reversals', 'command, rms'].map(textContent => make('th', {scope: 'col', textContent}));
    const rows = axis.rows.map(([name, ...values]) => make('tr', {}, make('th', {scope: 'row', textContent: name.replaceAll('_', ' ')}),
        ...values.map(v => make('td', {textContent: v.replace(' ', '\u00a0').replace(' to ', '\u00a0to\u00a0')}))));
    const parts = [make('h3', {textContent: title})];
    if (rows.length) parts.push(make('div', {className: 'wide', tabIndex: 0, role: 'region', ariaLabel: title},
        make('table', {}, make('thead', {}, make('tr', {}, ...titles)), make('tbody', {}, ...rows))));
    if (axis.after) {
        const canvas = make('canvas');
        canvas.setAttribute('role', 'img');
        canvas.setAttribute('aria-label', `${title} of the simulated loop, as it is and with the controller's keys set; the table above has the numbers`);
        parts.push(make('h3', {textContent: 'Reference minus position, simulated'}),
            make('p', {className: 'legend'}, make('span', {}, make('i', {style: 'background:var(--before)'}), 'the controller as it is'), ' ',
                make('span', {}, make('i', {style: 'background:var(--after)'}), 'with its feedforward keys set')), canvas);
    }
    return [...parts, ...axis.says.map(textContent => make('p', {className: 'hint', textContent}))];
}

function draw_gains() {
    const canvases = the('gains').querySelectorAll('canvas');
    let next = 0;
    for (const axis of gains?.axes ?? [])
        if (axis.after) draw_curve(canvases[next++], 'm', axis.after.seconds, axis.before.lines, axis.after.lines);
}

async function compute_compensation() {
    the('compensation').hidden = !the('compensated').checked;
    if (!the('compensated').checked || at_work) return;
    at_work = true;
    const began = performance.now(), answer = await call({do: 'compensate', ...wanted()});
    at_work = false;
    if (answer.cancelled) return;
    gains = answer.error ? null : answer;
    the('compensation').querySelector('.fault').textContent = answer.error || '';
    the('gains').replaceChildren(...(gains?.axes ?? []).flatMap(a => gains_of(a, gains.axes.length > 1)),
        ...(gains?.notes ?? []).map(note => make('p', {className: 'hint', textContent: `Note: ${note}.`})));
    the('save-compensation').disabled = !gains;
    the('save-compensated').disabled = !gains?.machine_text;
    the('forecast-took').textContent = answer.error ? '' : `Forecast in ${((performance.now() - began) / 1000).toFixed(1)} s.`;
    draw_gains();
    if (again) { again = false; compute_what_if(); }
}

function show_what_if(answer) {
    found = answer;
    shown = gains = null;
    the('compensated').checked = false;
    the('saved').textContent = '';
    the('what-if').hidden = !answer.causes.length;
    if (!answer.causes.length) return;
    lay_out_knobs(answer);
    the('curves').replaceChildren(...answer.before.flatMap(axis => axis.charts.flatMap(chart => {
        const title = answer.before.length > 1 ? `Axis ${axis.axis}: ${chart.title}` : chart.title;
        const canvas = make('canvas');
        canvas.setAttribute('role', 'img');
        canvas.setAttribute('aria-label', `${title}, of the machine file and with these values; the table above has the numbers`);
        return [make('h3', {textContent: title}), canvas];
    })));
    return compute_what_if();
}

the('knobs').addEventListener('input', compute_what_if);
the('as-found').addEventListener('click', () => { lay_out_knobs(found); compute_what_if(); });
the('save-machine').addEventListener('click', () => save('machine.json', shown.machine_text, 'application/json'));
for (const button of the('save-as').querySelectorAll('button'))
    button.addEventListener('click', async () => {
        const answer = await call({do: 'export', as: button.dataset.as, ...wanted()});
        if (answer.cancelled) return;
        the('what-if').querySelector('.fault').textContent = answer.error || '';
        if (answer.error) return;
        save(answer.name, answer.text, answer.type);
        the('saved').textContent = [`${answer.name} is saved.`, ...answer.notes.map(note => `Note: ${note}.`)].join(' ');
    });
the('compensated').addEventListener('change', compute_compensation);
the('save-compensation').addEventListener('click', () => save('compensation.json', gains.forecast, 'application/json'));
the('save-compensated').addEventListener('click', () => save('machine.json', gains.machine_text, 'application/json'));
for (const draw of [draw_what_if, draw_gains]) {
    addEventListener('resize', draw);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
}
