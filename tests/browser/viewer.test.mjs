// SPDX-License-Identifier: MIT
// The page of render -o FILE.html and the npm module, in Debian's chromium with its software GL.
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import test, { after, before } from "node:test";
import { pathToFileURL } from "node:url";
import { file, golden, here, launch, microtin, npm, remove, served } from "./files.mjs";

const { MICROTIN_SCREENSHOT: screenshot } = process.env;

let browser;

before(async () => {
  microtin("fractal", "--size", "257", "--seed", "3", "-o", "area.asc");
  for (const [name, ...words] of [["area.mtp", "--tile-vertices", "500"], ["area.mtin"]]) {
    microtin("encode", "area.asc", "--units", "metre", "--max-error", "8", "--fast", ...words, "-o", name);
    microtin("render", name, "-o", name.replace("area.", "") + ".html");
  }
  microtin("encode", "area.asc", "--units", "metre", "--max-error", "8", "--fast", "--tile-vertices", "100", "--max-degree", "6",
    "--source-name", "Survey <of> A & B", "--date", "2026-11", "--attribution", "by <b>\u001b",
    "--license", "CC-BY-4.0", "-o", "many.mtp");
  microtin("render", "many.mtp", "-o", "many.html");
  const tall = fs.readFileSync(file("area.asc"), "utf8").replace("cellsize 30", "cellsize 0.2");
  fs.writeFileSync(file("tall.asc"), tall);
  microtin("encode", "tall.asc", "--units", "metre", "--max-error", "8", "--fast", "-o", "tall.mtin");
  microtin("render", "tall.mtin", "-o", "tall.html");
  microtin("render", "area.mtp", "--width", "600", "-o", "area.png");
  microtin("fractal", "--size", "1025", "--seed", "5", "-o", "large.asc"); // so large that it has phases
  microtin("encode", "large.asc", "--units", "metre", "--max-error", "1.8", "--fast", "-o", "large.mtin");
  microtin("render", "large.mtin", "-o", "large.html");
  browser = await launch();
});

after(async () => {
  await browser?.close();
  remove();
});

// A page that has come to an end: "complete", "failed" or "flat".
async function open(url, expected, { prepare, from = browser } = {}) {
  const page = await from.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  await page.setViewport({ width: 900, height: 900 });
  await prepare?.(page);
  await page.goto(url);
  await page.waitForFunction("document.body.dataset.state", { timeout: 60_000 });
  assert.equal(await page.evaluate("document.body.dataset.state"), expected);
  assert.deepEqual(errors, []);
  return page;
}

const facts = (page) => page.$eval("#facts", (element) => element.textContent);

// Until what was asked for has been drawn, and is seen.
async function settled(page) {
  await page.waitForFunction("document.body.dataset.drawn === document.body.dataset.asked", { timeout: 10_000 });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

// Width, height and pixels (red, green, blue, opacity) of a picture, read by the browser.
async function pixelsOf(page, png) {
  const { width, height, text } = await page.evaluate(async (address) => {
    const image = new Image();
    image.src = address;
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let text = "";
    for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
    return { width: image.width, height: image.height, text: btoa(text) };
  }, `data:image/png;base64,${Buffer.from(png).toString("base64")}`);
  return { width, height, pixels: Buffer.from(text, "base64") };
}

// The rectangle of a map without voids: its rows and columns are coloured for the most part.
function mapIn({ width, height, pixels }) {
  const isColoured = (x, y) => {
    const at = 4 * (y * width + x), colour = [...pixels.subarray(at, at + 3)];
    return Math.max(...colour) - Math.min(...colour) > 8 || Math.max(...colour) < 200;
  };
  const count = (length, test) => Array.from({ length }, (_, i) => test(i)).filter(Boolean).length;
  const rows = Array.from({ length: height }, (_, y) => y).filter((y) => count(width, (x) => isColoured(x, y)) > 0.85 * width);
  const middle = rows.slice(rows.length / 4, (3 * rows.length) / 4);
  const columns = Array.from({ length: width }, (_, x) => x)
    .filter((x) => middle.filter((y) => isColoured(x, y)).length > 0.6 * middle.length);
  return { left: columns[0], top: rows[0], width: columns.at(-1) - columns[0] + 1, height: rows.at(-1) - rows[0] + 1 };
}

// The mean colour of a square part of a map at a place, 0 .. 1 from the left and from the top.
function colourAt({ width, pixels }, map, u, v) {
  const sum = [0, 0, 0];
  const reach = map.width / 100;
  const [x, y] = [map.left + u * map.width, map.top + v * map.height];
  let count = 0;
  for (let row = Math.round(y - reach); row <= y + reach; ++row) {
    for (let column = Math.round(x - reach); column <= x + reach; ++column, ++count) {
      for (let i = 0; i < 3; ++i) sum[i] += pixels[4 * (row * width + column) + i];
    }
  }
  return sum.map((value) => value / count);
}

// The middle of the page, to be compared.
async function viewOf(page) {
  const clip = { x: 100, y: 120, width: 700, height: 600 };
  return Buffer.from(await page.screenshot({ clip })).toString("base64");
}

const onDisk = (name) => pathToFileURL(file(name)).href;

// The picture of the README is what is seen, but for what another encoder or driver changes. MICROTIN_SCREENSHOT: makes it.
async function compareWithReadme(page, seen) {
  if (screenshot) fs.writeFileSync(screenshot, seen);
  const [now, then] = [await pixelsOf(page, seen), await pixelsOf(page, fs.readFileSync(path.join(here, "viewer.png")))];
  assert.deepEqual([now.width, now.height], [then.width, then.height]);
  const sum = now.pixels.reduce((total, value, i) => total + Math.abs(value - then.pixels[i]), 0);
  assert.ok(sum / now.pixels.length < 8, `on average ${sum / now.pixels.length} of 255`);
}

const PLAIN = "header, #controls, #legend, #pointer { display: none }"; // nothing but the terrain

// What the page says of a whole file: its bytes, those read, and those of the first picture.
async function bytesIn(page) {
  const [read, size, first] = (await facts(page)).replaceAll(",", "").match(/\d+(?= of | bytes)/g).map(Number);
  return { read, size, first };
}

const setSlider = (page, id, value) => page.$eval(`#${id}`, (element, to) => {
  element.value = to;
  element.dispatchEvent(new Event("input", { bubbles: true }));
}, value);

// How many pixels the terrain covers, and how many of them lie at the rim of the view.
async function covered(page) {
  await settled(page);
  const { width, height, pixels } = await pixelsOf(page, await page.screenshot());
  let all = 0, rim = 0;
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      if (Math.min(...pixels.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)) > 250) continue;
      ++all;
      if (x === 0 || y === 0 || x === width - 1 || y === height - 1) ++rim;
    }
  }
  return { all, rim };
}

test("a page opens from disk and shows a pack, and a stream", async () => {
  for (const name of ["mtp.html", "mtin.html"]) {
    const page = await open(onDisk(name), "complete");
    assert.match(await facts(page), /^[1-9][\d,]+ vertices, ([\d,]+) of \1 bytes, at most 8 m off, first seen after [\d,]+ bytes$/);
    await page.mouse.move(450, 450);
    await page.waitForFunction("document.getElementById('pointer').textContent !== ''", { timeout: 10_000 });
    assert.match(await page.$eval("#pointer", (element) => element.textContent), /^[\d.,-]+ m ± 8\n[\d.-]+, [\d.-]+$/);
    if (name === "mtp.html") {
      await page.setViewport({ width: 760, height: 560 });
      await page.click("#tiles");
      await settled(page);
      await compareWithReadme(page, await page.screenshot());
    }
    await page.close();
  }
});

test("the map has the colours of the picture that render draws", async () => {
  const page = await open(onDisk("mtp.html"), "complete");
  await page.click("#map");
  await page.addStyleTag({ content: PLAIN });
  await settled(page);
  const seen = await pixelsOf(page, await page.screenshot());
  const drawn = await pixelsOf(page, fs.readFileSync(file("area.png")));
  const maps = [mapIn(seen), mapIn(drawn)];
  // View and terrain are squares about one middle; white summits at the rim hide where rows begin.
  maps[0] = { ...maps[0], top: maps[0].left, height: maps[0].width };
  for (const map of maps) assert.ok(map.width > 300 && Math.abs(map.width / map.height - 1) < 0.02, JSON.stringify(map));
  let worst = 0, sum = 0, count = 0;
  for (let u = 0.03; u < 0.28; u += 0.02) { // lines fade in behind
    for (let v = 0.03; v < 0.97; v += 0.02, ++count) {
      const [a, b] = [colourAt(seen, maps[0], u, v), colourAt(drawn, maps[1], u, v)];
      const difference = Math.max(...a.map((value, i) => Math.abs(value - b[i])));
      worst = Math.max(worst, difference);
      sum += difference;
    }
  }
  assert.ok(sum / count < 6, `on average ${sum / count} of 255, at most ${worst}`);
  await page.close();
});

test("a pack of more tiles than are kept is read once, from a page and from a server", async () => {
  const bytes = fs.readFileSync(file("many.mtp"));
  const inPage = await open(onDisk("many.html"), "complete");
  const told = await bytesIn(inPage);
  assert.deepEqual([told.read, told.size], [bytes.length, bytes.length]);
  assert.ok(told.first <= bytes.length);
  await inPage.close();
  let sent = 0;
  await served((request, response) => {
    if (!request.url.startsWith("/many.mtp")) return response.end(fs.readFileSync(file("many.html")));
    const [from, to] = /(\d+)-(\d+)/.exec(request.headers.range).slice(1).map(Number);
    const part = bytes.subarray(from, to + 1);
    sent += part.length;
    response.writeHead(206, { "Content-Range": `bytes ${from}-${from + part.length - 1}/${bytes.length}` }).end(part);
  }, async (address) => {
    const page = await open(`${address}/?file=many.mtp`, "complete");
    assert.deepEqual(await bytesIn(page), told);
    assert.equal(sent, bytes.length);
    await page.close();
  });
});

test("a terrain taller than wide is in view, and whole finds it at any scale of heights", async () => {
  const page = await open(onDisk("tall.html"), "complete");
  await page.addStyleTag({ content: PLAIN });
  const first = await covered(page);
  assert.ok(first.all > 20_000 && first.rim === 0, JSON.stringify(first));
  for (const scale of [1, 10]) {
    await setSlider(page, "scale", scale);
    await page.$eval("#whole", (button) => button.click());
    const whole = await covered(page);
    assert.ok(whole.all > 500 && whole.rim === 0, `${scale}: ${JSON.stringify(whole)}`);
    await page.$eval("#map", (button) => button.click());
    const map = await covered(page);
    assert.ok(map.all > 300_000 && map.rim === 0, `${scale}: ${JSON.stringify(map)}`);
  }
  await page.close();
});

test("the legend tells heights, a length, north and the source", async () => {
  const page = await open(onDisk("many.html"), "complete");
  const words = (id) => page.$eval(`#${id}`, (element) => element.textContent);
  const { heights } = JSON.parse(microtin("info", "many.mtp", "--json").toString());
  const number = (value) => value.toFixed(1).replace(/\.0$/, "").replace(/\B(?=(\d{3})+$)/, ",");
  assert.deepEqual([await words("lowest"), await words("highest")],
    [`${number(heights.lowest)} m`, `${number(heights.highest)} m`]);
  assert.equal(await words("source"), "Survey <of> A & B, 2026-11, by <b>\u001b, CC-BY-4.0");
  const rotation = () => page.$eval("#north", (element) => parseFloat(getComputedStyle(element).rotate));
  await settled(page);
  const before = await rotation();
  await page.focus("#view");
  await page.keyboard.press("ArrowRight");
  await settled(page);
  assert.ok(Math.abs(await rotation() - before) > 1);
  await page.click("#map");
  await settled(page);
  assert.equal(Math.abs(await rotation()), 0);
  const placeAt = async (x) => {
    await page.mouse.move(x, 450);
    await settled(page);
    await page.waitForFunction("document.getElementById('pointer').textContent !== ''", { timeout: 10_000 });
    await new Promise((done) => setTimeout(done, 300));
    return Number(/\n([\d.-]+),/.exec(await words("pointer"))[1]);
  };
  const perPixel = (await placeAt(650) - await placeAt(250)) / 400;
  const [length, unit] = (await words("length")).split(" ");
  const width = await page.$eval("#bar", (bar) => bar.getBoundingClientRect().width);
  assert.ok(width > 30 && width <= 100);
  assert.ok(Math.abs(Number(length) * (unit === "km" ? 1000 : 1) / width / perPixel - 1) < 0.02);
  await page.close();
});

test("phases, mesh and tiles change what is seen; keys move", async () => {
  const page = await open(onDisk("mtp.html"), "complete");
  await page.addStyleTag({ content: "#pointer { visibility: hidden }" });
  const views = new Set();
  const look = async () => {
    await settled(page);
    views.add(await viewOf(page));
  };
  await look();
  for (const id of ["mesh", "tiles"]) {
    await page.click(`#${id}`);
    await look();
  }
  for (const key of ["ArrowLeft", "ArrowUp", "+", "w", "d", "r"]) {
    await page.focus("#view");
    await page.keyboard.press(key);
    await look();
  }
  assert.equal(views.size, 9);
  await page.close();
});

test("two clicks draw a profile, and say whether masts see each other as the program does", async () => {
  const page = await open(onDisk("many.html"), "complete");
  await page.click("#map");
  await settled(page);
  await page.click("#line");
  const sight = () => page.$eval("#sight", (element) => element.textContent);
  assert.match(await sight(), /first end/);
  const places = [];
  for (const [x, y] of [[300, 350], [600, 550]]) {
    await page.mouse.click(x, y);
    await settled(page);
    await page.waitForFunction((before) => document.getElementById("sight").textContent !== before, {}, await sight())
      .catch(() => {});
    places.push(await page.$eval("#pointer", (element) => /\n([\d.-]+), ([\d.-]+)/.exec(element.textContent).slice(1)));
  }
  await page.waitForFunction("document.getElementById('profile').dataset.result", { timeout: 10_000 });
  for (const mast of [2, 5000]) {
    await page.$eval("#mast", (input, value) => {
      input.value = value;
      input.dispatchEvent(new Event("input", { bubbles: true }));
    }, mast);
    const report = JSON.parse(microtin("profile", "many.mtp", ...places.flat(), "--from-height", String(mast),
      "--to-height", String(mast), "--json").toString());
    assert.equal(await page.$eval("#profile", (panel) => panel.dataset.result), report.line_of_sight);
    const [length, first] = (await sight()).replaceAll(",", "").match(/[\d.]+(?= m)/g).map(Number);
    assert.ok(Math.abs(length - report.length) < 2, `${length} ${report.length}`);
    if (first !== undefined) assert.ok(Math.abs(first - report.first_obstruction_at) < 20, `${first}`);
  }
  assert.match(await page.$eval("#ground", (path) => path.getAttribute("d")), /^M[\d.]+ [\d.]+L/);
  await page.click("#line");
  assert.equal(await page.$eval("#profile", (panel) => panel.hidden), true);
  await page.close();
});

test("one finger turns the terrain, two bring it nearer", async () => {
  const page = await open(onDisk("mtp.html"), "complete");
  await page.addStyleTag({ content: "#pointer { visibility: hidden }" });
  const input = await page.createCDPSession();
  const touch = (type, ...places) =>
    input.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([x, y], id) => ({ x, y, id })) });
  const views = new Set();
  const look = async () => {
    await settled(page);
    views.add(await viewOf(page));
  };
  await look();
  for (const [from, to] of [[[[400, 400]], [[460, 420]]], [[[400, 400], [500, 500]], [[350, 350], [550, 550]]]]) {
    await touch("touchStart", ...from);
    await touch("touchMove", ...to);
    await touch("touchEnd");
    await look();
  }
  assert.equal(views.size, 3);
  await page.close();
});

test("the page is dark or light as the reader wants it", async () => {
  const page = await open(onDisk("mtin.html"), "complete");
  const lightness = async (scheme) => {
    await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
    return page.evaluate(() => ["backgroundColor", "color"].map((name) =>
      Math.max(...getComputedStyle(document.body)[name].match(/\d+/g).map(Number))));
  };
  const [paper, ink] = await lightness("light");
  assert.ok(paper > ink + 150);
  const [night, glow] = await lightness("dark");
  assert.ok(glow > night + 150);
  await page.close();
});

test("phases arrive live from a slow server, and can be gone back to", async () => {
  const bytes = fs.readFileSync(file("large.mtin"));
  await served(async (request, response) => {
    if (!request.url.startsWith("/large.mtin")) {
      response.writeHead(200, { "Content-Type": "text/html" }).end(fs.readFileSync(file("large.html")));
      return;
    }
    response.writeHead(200);
    for (let i = 0; i < bytes.length; i += 10000) {
      response.write(bytes.subarray(i, i + 10000));
      await new Promise((done) => setTimeout(done, 100));
    }
    response.end();
  }, async (address) => {
    const page = await browser.newPage();
    await page.setViewport({ width: 900, height: 900 });
    await page.goto(`${address}/?file=large.mtin`);
    await page.waitForFunction("document.getElementById('facts').textContent.includes('so far')", { timeout: 10_000 });
    await page.waitForFunction("document.body.dataset.state === 'complete'", { timeout: 20_000 });
    const phases = Number(await page.$eval("#phase", (element) => element.max));
    assert.ok(phases > 1);
    await page.click("#mesh");
    const views = new Set();
    for (const phase of [phases, 1, phases]) {
      await page.$eval("#phase", (element, value) => {
        element.value = value;
        element.dispatchEvent(new Event("input", { bubbles: true }));
      }, phase);
      await settled(page);
      views.add(await viewOf(page));
    }
    assert.equal(views.size, 2);
    await page.close();
  });
});

test("a damaged file ends in a message, and the page lives", async () => {
  const page = fs.readFileSync(file("mtin.html"), "utf8");
  const bytes = fs.readFileSync(file("area.mtin"));
  const good = bytes.toString("base64");
  bytes[bytes.length >> 1] ^= 1;
  fs.writeFileSync(file("damaged.html"), page.replace(good, bytes.toString("base64")));
  const shown = await open(onDisk("damaged.html"), "failed");
  assert.match(await facts(shown), /damaged/);
  await shown.click("#map");
  assert.match(await facts(shown), /damaged/);
  await shown.close();
});

test("without WebGL there are a sentence and the flat picture", async () => {
  const without = await launch(["--no-sandbox", "--disable-gpu", "--disable-software-rasterizer"]);
  try {
    const page = await open(onDisk("mtp.html"), "flat", { from: without });
    assert.match(await page.$eval("#why", (element) => element.textContent), /shown flat/);
    assert.ok(await page.$eval("#flat img", (image) => image.naturalWidth > 100));
  } finally {
    await without.close();
  }
});

// The tasks of the page's own thread while it shows a terrain: the longest, and the one that takes the processor for the
// longest time, in milliseconds.
async function longestTasks(url) {
  const page = await open(url, "complete", {
    prepare: (blank) => blank.tracing.start({ categories: ["toplevel", "disabled-by-default-devtools.timeline"] }),
  });
  const { traceEvents } = JSON.parse(Buffer.from(await page.tracing.stop()).toString());
  const committed = traceEvents.find(({ name, args }) => name === "FrameCommittedInBrowser" && args.data.url === url);
  const { pid, tid } = traceEvents.find(({ name, pid, args }) =>
    name === "thread_name" && args.name === "CrRendererMain" && pid === committed.args.data.processId);
  const tasks = traceEvents.filter((event) =>
    event.name === "ThreadControllerImpl::RunTask" && event.ph === "X" && event.pid === pid && event.tid === tid);
  assert.ok(tasks.length > 10);
  const shown = await facts(page);
  await page.close();
  const longest = (kind) => Math.max(...tasks.map((task) => task[kind] ?? 0)) / 1000;
  return { shown, length: longest("dur"), work: longest("tdur") };
}

test("200,000 vertices leave the page's thread free, and are seen after 2 % of the bytes", async (t) => {
  const runs = [];
  for (let run = 0; run < 3; ++run) runs.push(await longestTasks(onDisk("large.html")));
  const [vertices, , first] = runs[0].shown.replaceAll(",", "").match(/\d+(?= vertices| bytes)/g).map(Number);
  const bytes = fs.statSync(file("large.mtin")).size;
  const work = Math.max(...runs.map((run) => run.work)), length = Math.min(...runs.map((run) => run.length));
  t.diagnostic(`${vertices} vertices; a task of the page's thread works for ${work} ms at most`);
  t.diagnostic(`with what it waits for, ${length} ms in the best of three runs`);
  t.diagnostic(`first seen after ${first} of ${bytes} bytes`);
  assert.ok(vertices >= 200_000);
  assert.ok(work <= 50);
  // On a busy machine tasks last longer than they work: one waits for a processor.
  if (os.loadavg()[0] < os.availableParallelism()) assert.ok(length <= 50);
  assert.ok(first <= 0.02 * bytes);
});

test("every golden stream has its digest in a worker of the browser", async () => {
  const names = fs.readdirSync(golden).filter((name) => name.endsWith(".mtin"));
  await served((request, response) => {
    const [, kind, name] = request.url.split("/");
    if (kind === "golden") response.writeHead(200).end(fs.readFileSync(path.join(golden, name)));
    else if (kind === "microtin.js") {
      response.writeHead(200, { "Content-Type": "text/javascript" }).end(fs.readFileSync(path.join(npm, "microtin.js")));
    } else response.writeHead(200, { "Content-Type": "text/html" }).end("<!doctype html>");
  }, async (address) => {
    const page = await browser.newPage();
    await page.goto(address);
    const digests = await page.evaluate(async (all, base) => {
      const code = `import { decodeStream } from "${base}/microtin.js";
        onmessage = async ({ data }) => {
          let last;
          for await (last of decodeStream(await fetch(data)));
          postMessage(last.digest.toString(16).padStart(16, "0"));
        };`;
      const worker = new Worker(URL.createObjectURL(new Blob([code], { type: "text/javascript" })), { type: "module" });
      const found = [];
      for (const name of all) {
        const answer = new Promise((done) => { worker.onmessage = ({ data }) => done(data); });
        worker.postMessage(`${base}/golden/${name}`);
        found.push(await answer);
      }
      return found;
    }, names, address);
    const expected = names.map((name) =>
      /^digest (.*)$/m.exec(fs.readFileSync(path.join(golden, name.replace(/mtin$/, "report")), "utf8"))[1]);
    assert.deepEqual(digests, expected);
    await page.close();
  });
});
