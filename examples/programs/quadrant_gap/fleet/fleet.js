// SPDX-License-Identifier: BSL-1.0
// Sorting by a click on a head, and showing only what has a verdict, a cause, or a piece of text.
"use strict";
const body = document.querySelector("#logs tbody");
const rows = [...body.rows];
const heads = [...document.querySelectorAll("#logs thead th")];
const order = document.getElementById("order"), find = document.getElementById("find");
const picked = {verdict: null, effect: null};

function key(row, column) {
    const cell = row.cells[column];
    if (!cell || cell.classList.contains("why")) return null; // a log without numbers is last
    if (cell.dataset.value !== undefined) return Number(cell.dataset.value);
    return cell.textContent.trim() || null;
}

function sort(column, down) {
    heads.forEach((h, k) => k === column ? h.setAttribute("aria-sort", down ? "descending" : "ascending") : h.removeAttribute("aria-sort"));
    const sign = down ? -1 : 1;
    const compare = (a, b) => typeof a === "number" ? a - b : a.localeCompare(b, "en", {numeric: true});
    const keyed = rows.map(row => [key(row, column), row]);
    keyed.sort(([a], [b]) => a === null || b === null ? (a === null) - (b === null) : sign * compare(a, b));
    body.append(...keyed.map(([, row]) => row));
    order.value = `${column} ${down ? 1 : 0}`;
}

function show() {
    const text = find.value.trim().toLowerCase();
    let n = 0;
    for (const row of rows) {
        const good = (!picked.verdict || row.dataset.verdict === picked.verdict) &&
            (!picked.effect || row.dataset.effects.split(" ").includes(picked.effect)) &&
            (!text || row.textContent.toLowerCase().includes(text));
        row.hidden = !good;
        n += good;
    }
    document.getElementById("shown").textContent = n === rows.length ? "" : `${n} of ${rows.length} shown`;
}

heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = head.textContent;
    head.replaceChildren(button);
    const numbers = column >= 3; // the largest first
    button.addEventListener("click", () => sort(column, head.hasAttribute("aria-sort") ? head.getAttribute("aria-sort") === "ascending" : numbers));
    order.add(new Option(button.textContent, `${column} ${numbers ? 1 : 0}`));
    order.add(new Option(`${button.textContent}, reversed`, `${column} ${numbers ? 0 : 1}`));
});
order.addEventListener("change", () => { const [column, down] = order.value.split(" "); sort(Number(column), down === "1"); });
find.addEventListener("input", show);
for (const kind of ["verdict", "effect"])
    for (const button of document.querySelectorAll(`button[data-${kind}]`))
        button.addEventListener("click", () => {
            picked[kind] = picked[kind] === button.dataset[kind] ? null : button.dataset[kind];
            for (const other of document.querySelectorAll(`button[data-${kind}]`))
                other.setAttribute("aria-pressed", String(other.dataset[kind] === picked[kind]));
            show();
        });
sort(0, false);
