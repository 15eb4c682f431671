// SPDX-License-Identifier: MIT
// CesiumJS draws a pack on its globe, in chromium.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import test, { after } from "node:test";
import { degrees, file, here, launch, remove, served } from "./files.mjs";

const cesium = path.join(here, "node_modules/@cesium/engine");
const PAGE = `<!doctype html><div id="map" style="width: 500px; height: 400px"></div>
  <script>window.CESIUM_BASE_URL = "/Build/"</script><script type="module" src="/page.js"></script>`;
// Shows the whole pack; then tells heights of the drawn globe beside the pack's.
const SCRIPT = `
import * as cesium from "@cesium/engine";
import { Pack } from "microtin";
import { cesiumTerrain } from "microtin/cesium";
window.show = async () => {
  const pack = await Pack.open("/area.mtp");
  const terrainProvider = cesiumTerrain(cesium, pack);
  const { scene, camera } = new cesium.CesiumWidget("map", { terrainProvider, baseLayer: false, skyBox: false });
  const errors = [];
  terrainProvider.errorEvent.addEventListener(({ message }) => errors.push(message));
  scene.renderError.addEventListener((_, error) => errors.push(String(error)));
  const [[west, south], [east, north]] = [pack.tileBox(0), pack.tileBox(pack.columns * pack.rows - 1).slice(2)];
  camera.setView({ destination: cesium.Rectangle.fromDegrees(west, south, east, north) });
  const isLoaded = () => scene.globe.tilesLoaded && scene.globe.getHeight(cesium.Cartographic.fromDegrees((west + east) / 2, (south + north) / 2));
  while (!isLoaded()) await new Promise((done) => setTimeout(done, 100));
  const heights = [];
  for (let i = 1; i < 10; ++i) {
    const place = [west + ((east - west) * i) / 10, south + ((north - south) * ((3 * i) % 10)) / 10];
    heights.push([scene.globe.getHeight(cesium.Cartographic.fromDegrees(...place)), await pack.heightAt(...place)]);
  }
  return { errors, heights };
};`;

after(remove);

function bundled() {
  fs.writeFileSync(path.join(here, "globe.js"), SCRIPT);
  return execFileSync("esbuild", [path.join(here, "globe.js"), "--bundle", "--format=esm", "--log-level=error"],
    { maxBuffer: 2 ** 26 });
}

// The page, its script, the pack by ranges, and what CesiumJS brings.
function answer(script) {
  return (request, response) => {
    const name = request.url.split("?")[0];
    const own = { "/": ["text/html", PAGE], "/page.js": ["text/javascript", script] }[name];
    if (own) return response.writeHead(200, { "Content-Type": own[0] }).end(own[1]);
    const source = name === "/area.mtp" ? file("area.mtp") : path.join(cesium, path.normalize(name));
    if (!fs.existsSync(source)) return response.writeHead(404).end();
    const bytes = fs.readFileSync(source);
    const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range);
    if (range) return response.writeHead(206).end(bytes.subarray(Number(range[1]), Number(range[2]) + 1));
    return response.writeHead(200, { "Content-Type": name.endsWith(".js") ? "text/javascript" : "application/octet-stream" }).end(bytes);
  };
}

test("CesiumJS draws the pack, with its heights", async (t) => {
  degrees("area", { size: 257, encode: ["--max-error", "4", "--max-degree", "6", "--tile-vertices", "3000", "--tile-size", "60"] });
  const browser = await launch();
  try {
    await served(answer(bundled()), async (address) => {
      const page = await browser.newPage();
      await page.goto(address);
      await page.waitForFunction("window.show");
      const { errors, heights } = await page.evaluate("show()");
      assert.deepEqual(errors, []);
      const worst = Math.max(...heights.map(([drawn, real]) => Math.abs(drawn - real)));
      t.diagnostic(`at most ${worst.toFixed(3)} m between the globe and the pack`);
      assert.ok(worst < 1); // CesiumJS keeps places in 12 bits
    });
  } finally {
    await browser.close();
  }
});
