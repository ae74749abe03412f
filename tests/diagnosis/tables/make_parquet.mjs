// SPDX-License-Identifier: BSL-1.0
// Writes the Parquet files beside it, by two writers that share nothing with ours: parquet-wasm (arrow-rs) and hyparquet-writer.
// npm install parquet-wasm@0.8.0 apache-arrow@21.2.0 hyparquet-writer@0.17.0 && node make_parquet.mjs FOLDER
import {readFileSync, writeFileSync} from 'fs';
import * as arrow from 'apache-arrow';
import {parquetWriteBuffer} from 'hyparquet-writer';
import init, * as rust from 'parquet-wasm/esm';

await init(readFileSync('node_modules/parquet-wasm/esm/parquet_wasm_bg.wasm'));
const rows = [...Array(400).keys()], t = rows.map(k => k * 1e-3), r = t.map(s => 0.01 * Math.sin(20 * s)),
    x = r.map(v => Math.round(1e6 * v) * 1e-6), u = t.map(s => 10 * Math.cos(20 * s)), folder = process.argv[2];
const stamp = arrow.vectorFromArray(t.map((s, k) => new Date(1700000000000 + k)), new arrow.TimestampMillisecond());
const values = {t_s: arrow.vectorFromArray(t, new arrow.Float64()), x_ref_m: arrow.vectorFromArray(r, new arrow.Float64()),
    x_pos_m: arrow.vectorFromArray(x, new arrow.Float64()), x_cmd_V: arrow.vectorFromArray(u, new arrow.Float32())};
const table = new arrow.Table({...values, note: arrow.vectorFromArray(rows.map(k => `run ${k % 3}`)),
    count: arrow.vectorFromArray(rows.map(k => k % 5 === 4 ? null : k - 200), new arrow.Int32()), on: arrow.vectorFromArray(rows.map(k => k % 7 !== 0))});
const stamped = new arrow.Table({t: stamp, x_ref_m: values.x_ref_m, x_pos_m: values.x_pos_m, x_cmd_V: values.x_cmd_V});
function write(name, what, compression, version) {
    const how = new rust.WriterPropertiesBuilder().setCompression(compression).setWriterVersion(version).build();
    writeFileSync(`${folder}/${name}.parquet`, rust.writeParquet(rust.Table.fromIPCStream(arrow.tableToIPC(what, 'stream')), how));
}
write('snappy', table, rust.Compression.SNAPPY, rust.WriterVersion.V1);
write('gzip', stamped, rust.Compression.GZIP, rust.WriterVersion.V1);
write('plain_pages_2', table, rust.Compression.UNCOMPRESSED, rust.WriterVersion.V2);
write('zstd', table, rust.Compression.ZSTD, rust.WriterVersion.V1);
const columns = Object.entries({t_s: t, x_ref_m: r, x_pos_m: x, x_cmd_V: u}).map(([name, data]) => ({name, data, type: 'DOUBLE'}));
writeFileSync(`${folder}/hyparquet.parquet`, Buffer.from(parquetWriteBuffer({columnData: columns})));
