// SPDX-License-Identifier: Apache-2.0
// Shadows on meshes with smooth normals: what stands close to a facet shades it, and the mesh's own shadow is smooth.
import assert from 'node:assert/strict';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';

import { explainPixel, inputPath, readJson, tilelight } from './harness.mjs';
import { readPng } from './png.mjs';

let folder;
before(async () => { folder = await mkdtemp(path.join(os.tmpdir(), 'terminator-')); });
after(() => rm(folder, { recursive: true }));

async function run(scene, ...args) {
  const file = path.join(folder, 'scene.json');
  await writeFile(file, JSON.stringify(scene));
  const { code, stderr, stdout } = await tilelight('render', file, ...args);
  assert.equal(code, 0, stderr);
  return stdout;
}
const redAt = async (scene, ...args) => JSON.parse(await run(scene, '--pixel', '0', '0', ...args)).color_linear[0];
async function pictureOf(scene, render, ...args) {
  const file = path.join(folder, 'picture.png');
  await run({ ...scene, render: { ...scene.render, ...render } }, '-o', file, ...args);
  return readPng(await readFile(file));
}

// The drum of plate-over-smooth-facet.json, of facets of 30 degrees, its plate `gap` sagittas over the facet and the eye between them.
const kTop = 0.965925826;
async function covered(gap, { elevation = 90, isOneMesh = false, terminator = 'smooth' } = {}) {
  const scene = await readJson('plate-over-smooth-facet.json');
  const drum = scene.meshes.p, space = gap * (1 - kTop), angle = elevation * Math.PI / 180;
  const [low, high] = [[-0.2, kTop + space, -0.5], [0.2, kTop + space + 0.001, 0.5]];
  scene.camera.position = [0, kTop + space / 2, 0.1];
  scene.camera.target = [0, 0, 0.1];
  scene.lights[0].direction = [-Math.cos(angle), -Math.sin(angle), 0];
  scene.render = { terminator };
  scene.objects[1] = { type: 'box', min: low, max: high, material: 'm' };
  if (isOneMesh) {
    scene.objects.pop();
    const first = drum.positions.length / 3;
    for (let i = 0; i < 8; ++i) {
      drum.positions.push((i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]);
    }
    for (const [a, b, c, d] of [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]) {
      drum.indices.push(...[a, b, c, a, c, d].map((i) => first + i));
    }
  }
  return scene;
}

const minus = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
const unit = (a) => a.map((x) => x / Math.hypot(...a));

// A sphere by its parallels and meridians, with its own normals, turned and moved so that the middle of one facet beside
// the equator is the origin and looks along x; a lath over that facet, and the eye between them.
function globeUnderLath(gap, around = 48) {
  const points = [], indices = [], rows = around / 2;
  for (let row = 0; row <= rows; ++row) {
    for (let column = 0; column < around; ++column) {
      const polar = Math.PI * row / rows, angle = 2 * Math.PI * column / around;
      points.push([Math.sin(polar) * Math.cos(angle), Math.cos(polar), Math.sin(polar) * Math.sin(angle)]);
    }
  }
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < around; ++column) {
      const [a, b] = [row * around + column, row * around + (column + 1) % around];
      indices.push(a, b, b + around, a, b + around, a + around);
    }
  }
  const [a, b, c] = indices.slice(3 * (rows * around + 14), 3 * (rows * around + 15)).map((i) => points[i]);
  const middle = a.map((x, i) => (x + b[i] + c[i]) / 3);
  const axes = [unit(cross(minus(b, a), minus(c, a))), unit(minus(b, a))];
  axes.push(cross(axes[0], axes[1]));
  const turned = (p) => axes.map((axis) => dot(p, axis));
  return {
    image: { width: 1, height: 1 }, ambient: 0,
    camera: { type: 'orthographic', position: [gap / 2, 0, 0], target: [0, 0, 0], height: 1e-9 },
    lights: [{ type: 'directional', direction: [-1, 0, 0], intensity: 1 }],
    materials: { m: { diffuse: 1 } },
    meshes: {
      globe: {
        positions: points.flatMap((p) => turned(minus(p, middle))), normals: points.flatMap(turned), indices,
      },
    },
    objects: [
      { type: 'mesh', mesh: 'globe', material: 'm' },
      { type: 'box', min: [gap, -0.02, -0.02], max: [gap + 0.002, 0.02, 0.02], material: 'm' },
    ],
  };
}

test('A plate over a facet of a drum leaves it dark straight under the light, smooth or exact', async () => {
  for (const name of ['plate-over-smooth-facet.json', 'plate-over-exact-facet.json']) {
    assert.deepEqual((await explainPixel(name)).color_linear, [0, 0, 0], name);
  }
});

test('A plate shades the facet at every gap up to two sagittas, whatever mesh it belongs to and however low the light', async () => {
  for (const isOneMesh of [false, true]) {
    for (const gap of [1e-6, 0.01, 0.5, 1, 1.5, 2]) {
      for (const elevation of [90, 45, 20]) {
        const red = await redAt(await covered(gap, { elevation, isOneMesh }));
        assert.equal(red, 0, `gap of ${gap} sagittas, light at ${elevation} degrees, one mesh: ${isOneMesh}`);
      }
    }
  }
});

test('Light that comes in under the plate lights the facet, smooth or exact', async () => {
  for (const terminator of ['smooth', 'exact']) {
    const red = await redAt(await covered(2, { elevation: 15, terminator }));
    assert.ok(Math.abs(red - Math.sin(Math.PI / 12)) < 1e-9, `${terminator}: ${red}`);
  }
});

test('A lath close to a sphere of 48 by 24 facets shades it', async () => {
  for (const gap of [1e-6, 1e-3, 0.005, 0.008]) assert.equal(await redAt(globeUnderLath(gap)), 0, `gap of ${gap}`);
  const free = globeUnderLath(0.005);
  free.objects.pop();
  assert.ok(await redAt(free) > 0.99);
});

test('Every method and shading leaves the covered facet dark', async () => {
  for (const algorithm of ['raytrace', 'zbuffer', 'warnock']) {
    for (const shading of ['flat', 'gouraud', 'phong']) {
      const { rgb } = await pictureOf(await covered(1), { samples: 1 }, '--algorithm', algorithm, '--shading', shading);
      assert.deepEqual([...rgb], [0, 0, 0], `${algorithm}, ${shading}`);
    }
  }
});

test('Shadows of things on a smooth drum are those on an exact one wherever its facets face the light', async () => {
  const scene = await readJson('things-over-smooth-drum.json');
  scene.ambient = 0;
  scene.background = { bottom: 0, top: 0 };
  const [smooth, exact, bare] = [
    await pictureOf(scene, { samples: 1 }),
    await pictureOf(scene, { samples: 1, terminator: 'exact' }),
    await pictureOf(scene, { samples: 1, terminator: 'exact', shadows: false }),
  ];
  let facing = 0, shadowed = 0, differing = 0;
  for (let i = 0; i < bare.rgb.length; i += 3) {
    if (bare.rgb[i] === 0) continue;
    ++facing;
    shadowed += exact.rgb[i] === 0;
    differing += smooth.rgb.compare(exact.rgb, i, i + 3, i, i + 3) !== 0;
  }
  assert.ok(facing > 10_000 && shadowed > 1000, `${facing} ${shadowed}`);
  assert.equal(differing, 0);
});
