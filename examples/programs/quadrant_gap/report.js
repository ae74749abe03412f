// SPDX-License-Identifier: BSL-1.0
'use strict';
// Draws each <figure data-chart="k"> from charts[k]: {kind, axis, x, y, names, columns, medians, times}, column 0 is x.
const charts = JSON.parse(document.getElementById('charts').textContent);
const figures = [...document.querySelectorAll('figure[data-chart]')];
const graphs = {}; // the Dygraphs of each axis, which zoom together
const stills = {}; // what draws the charts of each axis that show the samples of the zoomed time
const colour = name => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const chart_of = figure => charts[figure.dataset.chart];
const digits = v => Number(v.toPrecision(4)).toString();

function legend(names, values) {
    return names.map((name, k) => `<span><i style="background:${colour(name)}"></i>${name}${values ? ' ' + values[k] : ''}</span>`).join(' ');
}

// ---- in time: Dygraphs ----

function nearest(graph, x) {
    let low = 0, high = graph.numRows() - 1;
    while (low < high) {
        const middle = (low + high) >> 1;
        if (graph.getValue(middle, 0) < x) low = middle + 1; else high = middle;
    }
    return low;
}

let linking = false; // a change caused by another chart is not passed on
function link(graph, action) {
    if (linking) return;
    linking = true;
    graphs[graph.axis].filter(other => other !== graph).forEach(action);
    linking = false;
}

function theme(names) {
    return {colors: names.map(colour), gridLineColor: colour('grid'), axisLineColor: colour('line'),
            rangeSelectorPlotStrokeColor: colour('muted'), rangeSelectorPlotFillColor: colour('track'),
            rangeSelectorForegroundStrokeColor: colour('muted'), rangeSelectorBackgroundStrokeColor: colour('line')};
}

// One finger scrolls the page, two fingers zoom.
const touch = Object.fromEntries(['touchstart', 'touchmove', 'touchend'].map(name => [name, (event, graph, context) => {
    if (event.touches.length > 1) Dygraph.defaultInteractionModel[name](event, graph, context);
}]));

// A few spikes do not flatten a chart: when the largest value is far beyond all but a thousandth of them, the chart shows
// those, and says how far the spikes go.
function spikes(columns) {
    const values = columns.flat().filter(v => v !== null).sort((a, b) => a - b), at = part => values[Math.round(part * (values.length - 1))];
    const low = at(0.001), high = at(0.999), span = high - low, most = Math.max(at(1), -at(0));
    return span > 0 && (at(1) - high > 3 * span || low - at(0) > 3 * span) ? {range: [low - span / 4, high + span / 4], most} : null;
}

function draw_time(figure) {
    const c = chart_of(figure), first = !graphs[c.axis], cut = spikes(c.columns.slice(1));
    const rows = c.columns[0].map((_, k) => c.columns.map(column => column[k]));
    const unit = (c.y.match(/\[(.+)\]/) || []).slice(1).map(text => ' ' + text).join(''); // "command [V]"
    const plot = figure.querySelector('.plot');
    plot.classList.toggle('first', first);
    const graph = new Dygraph(plot, rows, {
        ...theme(c.names), ...(cut ? {valueRange: cut.range} : {}), labels: ['time', ...c.names], xlabel: c.x, ylabel: c.y, axisLabelWidth: 50,
        strokeWidth: 1.2, series: {logged: {strokeWidth: c.names.length > 1 ? 4 : 1.2}}, xLabelHeight: 18, yLabelWidth: 18, highlightCircleSize: 3, showRangeSelector: first, rangeSelectorHeight: 34,
        underlayCallback: canvas => { canvas.lineJoin = 'round'; }, // a mitred zigzag shows spikes that the data have not
        legend: 'always', labelsDiv: figure.querySelector('.legend'),
        legendFormatter: data => legend(c.names, data.x === undefined ? null : data.series.map(s => s.y === undefined ? '' : digits(s.y)))
            + (cut ? ` <span>spikes up to ${digits(cut.most)}${unit} go beyond the chart</span>` : '')
            + (data.x === undefined ? '' : ` <span>at ${digits(data.x)} s</span>`),
        interactionModel: {...Dygraph.defaultInteractionModel, ...touch},
        axes: {x: {valueFormatter: digits, pixelsPerLabel: 70}, y: {valueFormatter: digits, pixelsPerLabel: 25}},
        drawCallback: (g, initial) => {
            if (initial || linking) return;
            link(g, other => other.updateOptions({dateWindow: g.isZoomed('x') ? g.xAxisRange() : null}));
            (stills[c.axis] || []).forEach(draw => requestAnimationFrame(draw));
        },
        highlightCallback: (event, x) => link(graph, other => other.setSelection(nearest(other, x))),
        unhighlightCallback: () => link(graph, other => other.clearSelection()),
    });
    for (const handle of plot.querySelectorAll('img')) handle.alt = ''; // of the range below the first chart
    graph.axis = c.axis;
    (graphs[c.axis] ||= []).push(graph);
    return () => { graph.updateOptions(theme(c.names)); graph.resize(); };
}

// ---- against velocity, position and frequency: canvas ----

function ticks([low, high], log) {
    if (log) {
        const marks = [1, 2, 5].slice(0, high / low > 300 ? 1 : 3), all = [];
        for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); ++e) all.push(...marks.map(m => m * 10 ** e));
        return all.filter(v => v >= low && v <= high);
    }
    const raw = (high - low) / 5, unit = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].find(m => m * unit >= raw) * unit, all = [];
    for (let k = Math.ceil(low / step); k * step <= high; ++k) all.push(k * step);
    return all;
}

function range(columns, log) {
    let low = Infinity, high = -Infinity;
    for (const column of columns) for (const v of column) if (v !== null && (!log || v > 0)) { low = Math.min(low, v); high = Math.max(high, v); }
    if (log) return [Math.max(low, high * 1e-6) / 1.2, high * 1.2];
    const margin = 0.05 * (high - low || 1);
    return [low - margin, high + margin];
}

function draw_still(figure) {
    const c = chart_of(figure), log = c.kind === 'spectrum', canvas = figure.querySelector('canvas');
    const ranges = [range([c.columns[0]], log), range(c.columns.slice(1), log)];
    const draw = () => {
        const graph = c.times && graphs[c.axis]?.[0], zoomed = graph?.isZoomed('x') ? graph.xAxisRange() : null;
        const shown = k => !zoomed || (c.times[k] >= zoomed[0] && c.times[k] <= zoomed[1]);
        figure.querySelector('.legend').innerHTML = legend(c.names)
            + (zoomed ? ` <span>dots of ${digits(zoomed[0])} to ${digits(zoomed[1])} s</span>` : '');
        const w = canvas.clientWidth, h = canvas.clientHeight, dpr = window.devicePixelRatio || 1;
        canvas.width = w * dpr;
        canvas.height = h * dpr;
        const pen = canvas.getContext('2d');
        pen.scale(dpr, dpr);
        const area = {left: 62, right: w - 10, top: 8, bottom: h - 44};
        const part = (v, [low, high]) => log ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low);
        const px = v => area.left + part(v, ranges[0]) * (area.right - area.left);
        const py = v => area.bottom - part(v, ranges[1]) * (area.bottom - area.top);
        pen.font = '13px ' + getComputedStyle(document.body).fontFamily;
        pen.fillStyle = colour('muted');
        pen.strokeStyle = colour('grid');
        pen.beginPath();
        pen.textAlign = 'center';
        for (const v of ticks(ranges[0], log)) {
            pen.moveTo(px(v), area.top);
            pen.lineTo(px(v), area.bottom);
            pen.fillText(digits(v), px(v), area.bottom + 17);
        }
        pen.textAlign = 'right';
        for (const v of ticks(ranges[1], log)) {
            pen.moveTo(area.left, py(v));
            pen.lineTo(area.right, py(v));
            pen.fillText(digits(v), area.left - 6, py(v) + 4);
        }
        pen.stroke();
        pen.textAlign = 'center';
        pen.fillText(c.x, (area.left + area.right) / 2, h - 6);
        pen.save();
        pen.translate(13, (area.top + area.bottom) / 2);
        pen.rotate(-Math.PI / 2);
        pen.fillText(c.y, 0, 0);
        pen.restore();
        pen.beginPath();
        pen.rect(area.left, area.top, area.right - area.left, area.bottom - area.top);
        pen.clip();

        const line = (xs, ys) => {
            pen.beginPath();
            ys.forEach((v, k) => { if (v !== null && xs[k] !== null && (!log || (v > 0 && xs[k] > 0))) pen.lineTo(px(xs[k]), py(v)); });
            pen.stroke();
        };
        c.names.forEach((name, s) => {
            pen.fillStyle = pen.strokeStyle = colour(name);
            pen.lineWidth = 1.4;
            if (log) return line(c.columns[0], c.columns[s + 1]);
            pen.globalAlpha = zoomed ? 0.8 : 0.35;
            c.columns[s + 1].forEach((v, k) => { if (v !== null && c.columns[0][k] !== null && shown(k)) pen.fillRect(px(c.columns[0][k]) - 1, py(v) - 1, 2, 2); });
            pen.globalAlpha = 1;
        });
        pen.lineJoin = 'round';
        for (const curves of c.medians) c.names.forEach((name, s) => {
            for (const [width, ink] of [[6, 'card'], [3, name]]) {
                pen.lineWidth = width;
                pen.strokeStyle = colour(ink);
                line(curves[0], curves[s + 1]);
            }
        });
    };
    draw();
    if (c.times) (stills[c.axis] ||= []).push(draw);
    return draw;
}

const redraws = figures.map(f => chart_of(f).kind === 'time' ? draw_time(f) : draw_still(f));
const redraw = () => redraws.forEach(r => r());
document.querySelectorAll('button[data-axis]').forEach(b => b.addEventListener('click', () => graphs[b.dataset.axis][0].resetZoom()));
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
addEventListener('resize', redraw);

// ---- on paper ----

// A browser prints what was drawn on a canvas from a list of strokes, and of Dygraphs' lists little is left: paper gets
// copies of the finished pictures, twice as fine as the screen.
function freeze(figure) {
    for (const canvas of figure.querySelectorAll('.plot canvas')) {
        if (!canvas.width || canvas.style.display === 'none') continue;
        const copy = canvas.cloneNode();
        copy.classList.add('frozen');
        copy.getContext('2d').drawImage(canvas, 0, 0);
        canvas.after(copy);
        canvas.classList.add('live');
    }
}
const times = figures.filter(f => chart_of(f).kind === 'time');
addEventListener('beforeprint', () => {
    document.documentElement.classList.add('printing');
    Object.values(graphs).flat().forEach(g => g.updateOptions({pixelRatio: 2}));
    redraw();
    times.forEach(freeze);
});
addEventListener('afterprint', () => {
    document.querySelectorAll('canvas.frozen').forEach(copy => copy.remove());
    document.querySelectorAll('canvas.live').forEach(canvas => canvas.classList.remove('live'));
    document.documentElement.classList.remove('printing');
    Object.values(graphs).flat().forEach(g => g.updateOptions({pixelRatio: null}));
    redraw();
});
