// SPDX-License-Identifier: MIT
// LAZ: laz-perf reads what the tests' encoder compresses, and microtin reads the same points.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import test, { after } from "node:test";
import { createLazPerf } from "laz-perf";
import { file, folder, microtin, remove } from "./files.mjs";

after(remove);
const POINTS = 4000;
const FORMATS = [0, 1, 2, 3, 6, 7, 8]; // laz-perf does not read 9 and 10
execFileSync(process.env.MICROTIN_MADE_SCANS, [folder, `${POINTS}`, ...FORMATS.map(String)]);
const perf = await createLazPerf();

// What microtin reads of a record: x, y and z, flags and class.
function values(record, format) {
  const flags = format < 6 ? record.subarray(15, 16) : Buffer.from([record[15] & 0x0f, record[16]]);
  return Buffer.concat([record.subarray(0, 12), flags]).toString("hex");
}

function decompressed(bytes) {
  const data = perf._malloc(bytes.length);
  perf.HEAPU8.set(bytes, data);
  const reader = new perf.LASZip();
  reader.open(data, bytes.length);
  const size = reader.getPointLength(), point = perf._malloc(size), records = [];
  for (let i = 0; i < reader.getCount(); ++i) {
    reader.getPoint(point);
    records.push(Buffer.from(perf.HEAPU8.slice(point, point + size)));
  }
  reader.delete();
  perf._free(point);
  perf._free(data);
  return records;
}

for (const format of FORMATS) {
  test(`laz-perf and microtin read the same points of format ${format}`, () => {
    const las = fs.readFileSync(file(`${format}.las`));
    const records = decompressed(fs.readFileSync(file(`${format}.laz`)));
    assert.equal(records.length, POINTS);
    const first = las.readUInt32LE(96), size = las.readUInt16LE(105);
    for (const [i, record] of records.entries()) {
      const stored = las.subarray(first + i * size, first + (i + 1) * size);
      assert.equal(values(record, format), values(stored, format), `point ${i + 1}`);
    }
    for (const suffix of ["las", "laz"]) {
      microtin("encode", `${format}.${suffix}`, "--classes", "all", "--fast", "-o", `${suffix}.mtin`);
    }
    assert.deepEqual(fs.readFileSync(file("laz.mtin")), fs.readFileSync(file("las.mtin")));
  });
}
