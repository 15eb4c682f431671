// SPDX-License-Identifier: MIT
// What tests stand on: terrains that the tool makes, in a folder that goes with them; a server; the browser.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";
import puppeteer from "puppeteer-core";

export const { MICROTIN: tool } = process.env;
export const { MICROTIN_NPM: npm, MICROTIN_GOLDEN: golden } = process.env;
export const here = path.dirname(fileURLToPath(import.meta.url));
export const folder = fs.mkdtempSync(path.join(os.tmpdir(), "browser-"));
export const file = (name) => path.join(folder, name);
export const microtin = (...words) => execFileSync(tool, words, { stdio: ["ignore", "pipe", "pipe"], cwd: folder });
export const remove = () => fs.rmSync(folder, { recursive: true });

const GL = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader"];
export const launch = (args = GL) => puppeteer.launch({ executablePath: "/usr/bin/chromium", args });

// The bytes of a pack of a fractal terrain, in EPSG:4326 if the options do not say another.
export function degrees(name, { size, cell = 1 / 3600, seed = 3, encode }) {
  microtin("fractal", "--size", `${size}`, "--seed", `${seed}`, "-o", `${name}.asc`);
  const text = fs.readFileSync(file(`${name}.asc`), "utf8")
    .replace("cellsize 30", `cellsize ${cell}`).replace("xllcenter 0", "xllcenter 7").replace("yllcenter 0", "yllcenter 43");
  fs.writeFileSync(file(`${name}.asc`), text);
  const system = encode.includes("--epsg") || encode.includes("--units") ? [] : ["--epsg", "4326", "--units", "degree:metre"];
  microtin("encode", `${name}.asc`, "--fast", ...system, ...encode, "-o", `${name}.mtp`);
  return new Uint8Array(fs.readFileSync(file(`${name}.mtp`)));
}

// Runs with the address of a server.
export async function served(answer, use) {
  const server = http.createServer(answer);
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  try {
    await use(`http://127.0.0.1:${server.address().port}`);
  } finally {
    server.closeAllConnections();
    server.close();
  }
}
