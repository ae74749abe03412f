// SPDX-License-Identifier: BSL-1.0
'use strict';
// The worker, as functions of the page: call(request) and put(file) give promises; restart() ends what it does.
const the = id => document.getElementById(id);
const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
};

const worker_url = URL.createObjectURL(new Blob([the('worker').textContent], {type: 'text/javascript'}));
const kept = new Map(); // every file that the worker holds, for its successor
let worker, waiting, sent, on_tell = () => {};

function post(message, moved) {
    return new Promise(resolve => {
        waiting.set(++sent, resolve);
        worker.postMessage({id: sent, ...message}, moved);
    });
}

function start_worker(again) {
    worker = new Worker(worker_url);
    waiting = new Map();
    sent = 0;
    worker.onmessage = ({data}) => {
        if (data.tell) return on_tell(data.tell, data.done);
        const resolve = waiting.get(data.id);
        waiting.delete(data.id);
        resolve(data.answer);
    };
    worker.onerror = fault => { for (const resolve of waiting.values()) resolve({error: fault.message || 'the worker failed'}); };
    post({wasm: the('wasm').textContent, again});
    for (const file of kept.values()) post({put: file});
}

const call = ask => post({ask});

async function put(name, bytes) {
    let sha256 = '';
    if (globalThis.crypto?.subtle)
        sha256 = [...new Uint8Array(await crypto.subtle.digest('SHA-256', bytes))].map(b => b.toString(16).padStart(2, '0')).join('');
    kept.set(name, {name, bytes, sha256});
    return post({put: kept.get(name)});
}

// Ends what is going on. What was read before is read again.
async function restart(looked) {
    worker.terminate();
    for (const resolve of waiting.values()) resolve({cancelled: true});
    start_worker(true);
    for (const request of looked) await call(request);
}

function save(name, text, type) {
    const url = URL.createObjectURL(new Blob([text], {type}));
    const link = make('a', {href: url, download: name});
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
}

start_worker();
