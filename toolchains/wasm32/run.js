// SPDX-License-Identifier: MIT
// node run.js MODULE: runs a firmware module. Its output and exit code become this program's.
const fs = require("fs");

let text = "";
const imports = {console: {put: (c) => { text += String.fromCharCode(c); }}};
const firmware = new WebAssembly.Module(fs.readFileSync(process.argv[2]));
const code = new WebAssembly.Instance(firmware, imports).exports.run();
process.stdout.write(text, () => process.exit(code));
