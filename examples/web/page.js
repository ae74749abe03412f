// SPDX-License-Identifier: BSL-1.0
// From the files to the verdict.
let result = null, running = false;

function choose(select, names, none, preferred) {
    const before = select.value;
    const first = none === undefined ? [] : [make('option', {value: '', textContent: none})];
    select.replaceChildren(...first, ...names.map(name => make('option', {value: name, textContent: name})));
    select.value = names.includes(before) ? before : preferred ?? '';
}

// Of several logs the longest is diagnosed, and the next one is its hold-out; one that is called hold-out is.
function by_use(logs) {
    const held_out = name => /hold.?out/i.test(name) ? 1 : 0;
    return [...logs].sort((a, b) => held_out(a) - held_out(b) || dropped.get(b).rows - dropped.get(a).rows);
}

on_files = () => {
    const logs = by_use(of_kind('log')), machines = of_kind('machine');
    the('start').hidden = !logs.length;
    if (!logs.length) return;
    choose(the('log'), logs, undefined, logs[0]);
    choose(the('holdout'), logs, 'none', logs[1]);
    choose(the('beside'), logs, 'nothing');
    choose(the('with'), machines, 'from the form above', machines.at(-1));
    follow_choice();
    if (machines.length && !running && !result && !of_kind('table').length) diagnose();
};

function follow_choice() {
    const by_form = the('with').value === '', beside = to_compare();
    show_form(by_form ? the('log').value : '');
    the('holdout').disabled = beside !== '';
    the('go').textContent = beside ? 'Find what differs' : 'Find the cause';
    the('go').disabled = running || (by_form && !begun && !beside);
}

// The log to compare with; none where it is the same.
const to_compare = () => the('beside').value === the('log').value ? '' : the('beside').value;

const fault_of_start = text => { the('start').querySelector('.fault').textContent = text; };

function run_state(on) {
    running = on;
    the('cancel').hidden = !on;
    the('go').disabled = on;
    the('progress').classList.toggle('busy', on);
    the('progress').setAttribute('aria-live', on ? 'off' : 'polite'); // a screen reader hears the end, not every line
    the('share').hidden = !on;
}

// "42 %, about 12 s left", as the program says it.
function in_per_cent(share, seconds) {
    const whole = share < 1 ? Math.min(99, Math.floor(100 * share)) : 100, left = seconds * (1 - share) / share;
    if (!(share >= 0.05 && share < 1 && seconds > 0.5)) return `${whole} %`;
    return `${whole} %, about ${left < 90 ? `${left.toFixed(0)} s` : `${(left / 60).toFixed(0)} min`} left`;
}

async function diagnose() {
    if (running) return;
    const beside = to_compare(), log = the('log').value, holdout = the('holdout').value === log ? '' : the('holdout').value, by_form = the('with').value === '';
    run_state(true);
    fault_of_start('');
    for (const id of ['verdict', 'what-if', 'report']) the(id).hidden = true;
    const began = performance.now();
    const since = () => `${((performance.now() - began) / 1000).toFixed(1)} s`;
    on_tell = (line, share) => {
        the('share').value = share;
        the('progress').textContent = `${in_per_cent(share, (performance.now() - began) / 1000)}: ${line}`;
    };
    on_tell('reading', 0);
    const known = !by_form || begun, machine = {machine: !known ? '' : by_form ? 'the form' : the('with').value, ...(by_form && begun ? {machine_text: begun} : {})};
    const answer = await call({...(beside ? {do: 'compare', beside} : {do: 'diagnose', holdout}), log, ...machine, fast: the('fast').checked});
    run_state(false);
    if (answer.cancelled) { the('progress').textContent = 'Cancelled.'; return; }
    the('progress').textContent = answer.error ? '' : `Done in ${since()}.`;
    if (answer.error) { fault_of_start(answer.error); return; }
    result = answer;
    show_result();
}

function show_result() {
    const badge = the('verdict').querySelector('.badge');
    badge.className = `badge ${result.verdict}`;
    badge.textContent = result.verdict.replaceAll('_', ' ');
    the('sentence').textContent = result.sentence;
    the('verdict').hidden = false;
    the('sentence').focus({preventScroll: true});
    if (result.causes) show_what_if(result);
    const frame = the('report');
    frame.hidden = false;
    frame.onload = () => {
        const fit = () => { frame.style.height = `${frame.contentDocument.body.scrollHeight + 20}px`; };
        new ResizeObserver(fit).observe(frame.contentDocument.body);
        fit();
    };
    frame.srcdoc = result.report;
}

the('go').addEventListener('click', diagnose);
the('cancel').addEventListener('click', () => restart([...dropped.values()].map(f => f.request)));
for (const id of ['log', 'holdout', 'with', 'beside']) the(id).addEventListener('change', follow_choice);
form.addEventListener('change', () => setTimeout(follow_choice));
the('save-report').addEventListener('click', () => save('report.html', result.report, 'text/html'));
the('save-diagnosis').addEventListener('click', () => save(result.causes ? 'diagnosis.json' : 'comparison.json', result.diagnosis, 'application/json'));
