// SPDX-License-Identifier: BSL-1.0
// Asks the diagnosis that a built page holds, in node: the module and the worker of the page as they were shipped.
// usage: node verdicts.js QUADRANT.html FOLDER...     a line of JSON for each folder with machine.json and log.csv
//                                                     (and holdout.csv): {folder, diagnosis}, or {folder, error}
'use strict';
const fs = require('fs'), path = require('path'), vm = require('vm');
const [page, ...folders] = process.argv.slice(2);
const text = fs.readFileSync(page, 'utf8');
const held = id => text.split(`<script type="text/plain" id="${id}">`)[1].split('</script>')[0].replaceAll('<\\/script', '</script');

// What a worker of a browser has and node has not.
const answers = new Map();
const scope = vm.createContext({
    console, performance, setTimeout, TextDecoder, TextEncoder, Uint8Array, ArrayBuffer, WebAssembly, Blob, Response, DecompressionStream, atob,
    location: {href: 'blob:page'}, importScripts() {}, onmessage: null,
    postMessage({id, answer}) {
        const resolve = answers.get(id);
        answers.delete(id);
        resolve?.(answer); // a line of progress has no id
    },
});
scope.self = scope.globalThis = scope;
let sent = 0;
const post = message => new Promise(resolve => {
    answers.set(++sent, resolve);
    scope.onmessage({data: {id: sent, ...message}});
});

async function diagnosis_of(folder) {
    const files = ['machine.json', 'log.csv', 'holdout.csv'].filter(name => fs.existsSync(path.join(folder, name)));
    for (const name of files) {
        await post({put: {name, bytes: fs.readFileSync(path.join(folder, name)), sha256: ''}});
        const looked = await post({ask: {do: 'look', file: name}});
        if (looked.error) return {error: looked.error};
    }
    const answer = await post({ask: {do: 'diagnose', machine: 'machine.json', log: 'log.csv', holdout: files[2] || ''}});
    return answer.error ? {error: answer.error} : {diagnosis: JSON.parse(answer.diagnosis)};
}

(async () => {
    vm.runInContext(held('worker'), scope, {filename: 'worker'});
    const fault = (await post({wasm: held('wasm')}))?.error;
    if (fault) throw new Error(fault);
    for (const folder of folders) console.log(JSON.stringify({folder, ...await diagnosis_of(folder)}));
})().catch(fault => {
    console.error(fault);
    process.exit(1);
});
