// SPDX-License-Identifier: BSL-1.0
// Runs the diagnosis off the page's thread. First message: {wasm}, the gzipped module in base64. Then {id, put} or
// {id, ask}; each is answered with {id, answer}. {tell, done} is a line of
// what is being tried, and the share of the work that is done.
'use strict';
let module;

async function start(base64, again) {
    const packed = Uint8Array.from(atob(base64), c => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
    module = await quadrant_module({wasmBinary: await new Response(stream).arrayBuffer()});
    if (!again) ask({do: 'warm up'}); // warm_up.hpp
}

function with_text(text, use) {
    const size = module.lengthBytesUTF8(text) + 1, at = module._malloc(size);
    module.stringToUTF8(text, at, size);
    try { return use(at); } finally { module._free(at); }
}

function put({name, bytes, sha256}) {
    const at = module._malloc(bytes.byteLength || 1);
    module.HEAPU8.set(new Uint8Array(bytes), at);
    with_text(name, n => with_text(sha256, s => module._quadrant_put(n, at, bytes.byteLength, s)));
    module._free(at);
    return {};
}

const ask = request => JSON.parse(with_text(JSON.stringify(request), at => module.UTF8ToString(module._quadrant_ask(at))));

let turn = Promise.resolve();
onmessage = ({data}) => {
    turn = turn.then(() => data.wasm ? start(data.wasm, data.again) : data.put ? put(data.put) : ask(data.ask))
        .catch(fault => ({error: String(fault)})).then(answer => postMessage({id: data.id, answer}));
};
