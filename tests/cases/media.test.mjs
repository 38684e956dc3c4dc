// SPDX-License-Identifier: Apache-2.0
// Glass that touches, glass that is wound inside out, and glass whose facets stand for curved surfaces.
import assert from 'node:assert/strict';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { post, readJson, startServer, tilelight } from './harness.mjs';
import { readPng } from './png.mjs';

let folder, server;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'tilelight-media-'));
  server = await startServer();
});
after(async () => {
  await server.stop();
  await rm(folder, { recursive: true });
});

let count = 0;
async function run(scene, command, ...args) {
  const path = join(folder, `${count++}.json`);
  await writeFile(path, JSON.stringify(scene));
  const result = await tilelight(command, path, ...args);
  assert.equal(result.code, 0, result.stderr);
  return result;
}
async function picture(scene) {
  const response = await post(server, '/v1/renders', scene, { Accept: 'image/png' });
  const bytes = Buffer.from(await response.arrayBuffer());
  assert.equal(response.status, 200, bytes.toString());
  return bytes;
}
const explain = async (scene, x = 0, y = 0) =>
  JSON.parse((await run(scene, 'render', '--pixel', `${x},${y}`)).stdout);
async function warnings(scene) {
  const response = await post(server, '/v1/plan', scene);
  assert.equal(response.status, 200);
  return (await response.json()).warnings;
}
// How many pixels of two pictures differ by more than a level in some channel.
async function differing(scene, other) {
  const [a, b] = [readPng(await picture(scene)).rgb, readPng(await picture(other)).rgb];
  let count = 0;
  for (let i = 0; i < a.length; i += 3) count += [0, 1, 2].some((c) => Math.abs(a[i + c] - b[i + c]) > 1);
  return count;
}
const codes = async (scene) => (await warnings(scene)).map((warning) => warning.code);
const turned = (scene) => ({ ...scene, objects: [...scene.objects].reverse() });

// A generator of its own, so that a failure can be repeated (mulberry32).
function randomFrom(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}
function shuffled(list, random) {
  const out = [...list];
  for (let i = out.length - 1; i > 0; --i) {
    const k = Math.floor(random() * (i + 1));
    [out[i], out[k]] = [out[k], out[i]];
  }
  return out;
}

const near = (a, b, within, what) => assert.ok(Math.abs(a - b) <= within, `${what}: ${a} is not ${b}`);
const add = (a, b, s = 1) => a.map((v, i) => v + s * b[i]);

test('from glass down into water and up again a shared face is one interface, by Snell\'s law, in both orders', async () => {
  for (const name of ['glass-on-water-down.json', 'glass-on-water-up.json']) {
    const scene = await readJson(name);
    const first = await explain(scene);
    const isDown = name.includes('down');
    const [from, to] = isDown ? [1.5, 1.33] : [1.33, 1.5];
    const [primary, next] = first.rays;
    assert.equal(next.kind, 'refracted');
    const sine = (ray) => Math.hypot(ray.direction[0], ray.direction[2]);
    near(from * sine(primary), to * sine(next), 1e-12, 'n sin');
    near(next.weight[0], 0.9, 1e-15, 'kt counts once');
    assert.deepEqual((await explain(turned(scene))).color_linear, first.color_linear);
  }
});

test('light goes the way back that it came', async () => {
  const scene = await readJson('glass-on-water-down.json');
  for (const objects of [scene.objects, [...scene.objects].reverse()]) {
    const [primary, next] = (await explain({ ...scene, objects })).rays;
    const place = add(next.origin, next.direction, 0.5);
    const back = { ...scene, objects, camera: { ...scene.camera, position: place, target: next.origin } };
    const [up, on] = (await explain(back)).rays;
    assert.equal(on.kind, 'refracted');
    for (let axis = 0; axis < 3; ++axis) {
      near(up.direction[axis], -next.direction[axis], 1e-6, 'aimed back');
      near(on.direction[axis], -primary.direction[axis], 2e-6, 'comes out as it went in');
    }
  }
});

test('faces that are in one place but for the rounding of their numbers touch', async () => {
  const base = await readJson('glass-on-water-down.json');
  const expected = await explain(base);
  const placed = (level, far) => {
    const scene = structuredClone(base);
    const [glass, water] = scene.objects;
    glass.min = add(glass.min, [far, level[0], 0]), glass.max = add(glass.max, [far, level[0], 0]);
    water.min = add(water.min, [far, level[1], 0]), water.max = add(water.max, [far, level[1], 0]);
    scene.camera.position = add(scene.camera.position, [far, level[0], 0]);
    scene.camera.target = add(scene.camera.target, [far, level[0], 0]);
    return scene;
  };
  const levels = [[0.3, 0.1 + 0.2], [0.1 + 0.2, 0.3], [1e7 / 3, 1e7 / 3]];
  for (const level of levels) {
    for (const far of [0, 1e7 / 7]) {
      for (const order of [(s) => s, turned]) {
        const seen = await explain(order(placed(level, far)));
        assert.equal(seen.rays.length, expected.rays.length, `${level}, ${far}`);
        near(seen.color_linear[0], expected.color_linear[0], 1e-12, `${level}, ${far}`);
      }
    }
  }
  const rotated = structuredClone(base);
  for (const object of rotated.objects) object.rotate_deg = { axis: [1, 2, 3], angle: 37 };
  assert.deepEqual((await explain(rotated)).color_linear, (await explain(turned(rotated))).color_linear);
});

// What a document adds to a far place is rounded on its way there, and what a placement adds is not.
test('a mesh that is moved far away touches the box that lies there', async () => {
  const base = await readJson('glass-on-water-down.json');
  const expected = readPng(await picture(base)).rgb[0];
  const random = randomFrom(3);
  for (const far of [0, 1e3, 1e5, 1e7, -1e7]) {
    for (let i = 0; i < 12; ++i) {
      const low = 0.2 + 0.1 * random();
      const scene = structuredClone(base);
      scene.meshes = { block: { positions: kCube.positions.map((v, k) => (k % 3 === 1 ? low + v : 18 * v)), indices: kCube.indices } };
      scene.objects[0] = { type: 'mesh', mesh: 'block', translate: [0, far, 0], material: 'g' };
      scene.objects[1].min[1] = far + low - 1, scene.objects[1].max[1] = far + low;
      for (const way of ['position', 'target']) scene.camera[way][1] += far + low;
      for (const order of [scene, turned(scene)])
        near(readPng(await picture(order)).rgb[0], expected, 1, `${low} at ${far}`);
      if (i > 0) continue;
      const [primary, next] = (await explain(scene)).rays;
      assert.equal(next.kind, 'refracted', `${low} at ${far}`);
      const sine = (ray) => Math.hypot(ray.direction[0], ray.direction[2]);
      near(1.5 * sine(primary), 1.33 * sine(next), 1e-9, `n sin, ${low} at ${far}`);
    }
  }
});

const kCube = {
  positions: [-0.5, 0, -0.5, 0.5, 0, -0.5, -0.5, 1, -0.5, 0.5, 1, -0.5, -0.5, 0, 0.5, 0.5, 0, 0.5, -0.5, 1, 0.5, 0.5, 1, 0.5],
  indices: [0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6],
};
// Every facet wound the other way.
const reversedIndices = (indices) => indices.map((v, i) => indices[i - (i % 3) + 2 - (i % 3)]);

test('a glass cube on a floor is one picture in both orders, whatever cube and floor are made of', async () => {
  const scene = await readJson('glass-cube-on-floor.json');
  scene.image = { width: 96, height: 72 };
  scene.render.samples = 1;
  scene.meshes = { cube: kCube, sheet: { positions: [-9, 0, -9, -9, 0, 9, 9, 0, 9, 9, 0, -9], indices: [0, 1, 2, 0, 2, 3] } };
  const cubes = [
    { type: 'cube', center: [0, 0.5, 0], material: 'g' },
    { type: 'box', min: [-0.5, 0, -0.5], max: [0.5, 1, 0.5], material: 'g' },
    { type: 'mesh', mesh: 'cube', material: 'g' },
    { type: 'mesh', mesh: 'cube', scale: [1, 1, -1], material: 'g' },
    { type: 'chess_piece', piece: 'pawn', material: 'g' },
  ];
  const floors = [{ type: 'plane', material: 'f' }, { type: 'box', min: [-9, -1, -9], max: [9, 0, 9], material: 'f' },
                  { type: 'mesh', mesh: 'sheet', material: 'f' }];
  for (const cube of cubes) {
    const pictures = [];
    for (const floor of floors) {
      pictures.push(await picture({ ...scene, objects: [floor, cube] }));
      pictures.push(await picture({ ...scene, objects: [cube, floor] }));
    }
    for (let i = 0; i < pictures.length; i += 2)
      assert.ok(pictures[i].equals(pictures[i + 1]), `${JSON.stringify(cube)} on ${JSON.stringify(floors[i / 2])}`);
  }
});

test('through glass that stands on a floor one sees the floor, and no air under the glass', async () => {
  const scene = {
    image: { width: 1, height: 1 }, ambient: 1, lights: [], background: { bottom: 0, top: 0 },
    camera: { position: [0.3, 5, 0.2], target: [0.1, 0, 0.1], fov_y_deg: 0.001 },
    materials: { g: { diffuse: 0, ambient: 0, transmission: 0.9 }, f: { ambient: 0.5, diffuse: 0 } },
    objects: [{ type: 'plane', material: 'f' }, { type: 'cube', center: [0, 0.5, 0], material: 'g' }],
  };
  for (const order of [scene, turned(scene)]) {
    const { color_linear, rays } = await explain(order);
    near(color_linear[0], 0.9 * 0.5, 1e-15, 'kt once, times the floor\'s light');
    assert.equal(rays.length, 2);
  }
});

test('a shadow through two plates that touch is the product of the faces\' tints, in every order', async () => {
  const plate = (low, high, material) => ({ type: 'box', min: [-5, low, -5], max: [5, high, 5], material });
  const scene = {
    image: { width: 1, height: 1 }, ambient: 0, background: { bottom: 0, top: 0 },
    lights: [{ type: 'directional', direction: [0, -1, 0] }],
    camera: { position: [20, 1, 0], target: [0.2, 0, 0.1], fov_y_deg: 0.001 },
    materials: { a: { diffuse: 0, transmission: 0.9 }, b: { diffuse: 0, transmission: 0.8, ior: 1.3 }, f: { diffuse: 1, ambient: 0 },
                 film: { diffuse: 0, transmission: 0.5 } },
    objects: [{ type: 'box', min: [-7, -1, -7], max: [7, 0, 7], material: 'f' }, plate(2, 3, 'a'), plate(3, 4, 'b'), plate(4, 4, 'film')],
  };
  const random = randomFrom(1);
  for (let i = 0; i < 8; ++i) {
    const { rays } = await explain({ ...scene, objects: shuffled(scene.objects, random) });
    near(rays[0].lights[0].visible[0], 0.9 * 0.9 * 0.8 * 0.8 * 0.5, 1e-15, 'tint');
  }
});

// Worlds of blocks that share faces, of balls on planes, films and meshes.
function world(random) {
  const pick = (list) => list[Math.floor(random() * list.length)];
  const objects = [{ type: 'plane', material: pick(['wood', 'film', 'wood']) }];
  for (let x = -1; x < 2; ++x) {
    for (let y = 0; y < 2; ++y) {
      const material = pick(['glass', 'flint', 'water', 'wood', 'film']);
      const lift = [0, 0.1, 0.2].reduce((a, b) => a + b, 0) - 0.3;  // 2^-54: not 0
      objects.push(pick([
        { type: 'box', min: [x - 0.5, y + lift, -0.5], max: [x + 0.5, y + 1, 0.5], material },
        { type: 'mesh', mesh: 'cube', translate: [x, y, 0], material },
        { type: 'mesh', mesh: 'turned', translate: [x, y, 0], material },
        { type: 'sphere', center: [x, y + 0.5, 0], radius: 0.5, material },
        { type: 'box', min: [x - 0.5, y, -0.5], max: [x + 0.5, y, 0.5], material },
      ]));
    }
  }
  return {
    image: { width: 64, height: 48 }, camera: { position: [2.2, 2.6, 3.9], target: [0, 0.8, 0] }, render: { samples: 1 },
    meshes: { cube: kCube, turned: { ...kCube, indices: reversedIndices(kCube.indices) } },
    materials: {
      glass: { diffuse: 0.02, reflection: 0.1, transmission: [0.9, 0.8, 0.7], priority: pick([0, 1]) },
      flint: { diffuse: 0, reflection: 1, transmission: 1, fresnel: true, ior: 1.7 },
      water: { diffuse: 0, transmission: [0.7, 0.9, 0.9], ior: 1.33, priority: pick([0, -1]) },
      film: { diffuse: 0.1, transmission: [0.9, 0.6, 0.6], reflection: 0.1 },
      wood: { diffuse: { checker: { size: 0.25 } } },
    },
    objects,
  };
}

test('worlds of touching things are one picture for every order of their objects, by every method', async () => {
  for (let seed = 1; seed <= 12; ++seed) {
    const random = randomFrom(seed);
    const scene = world(random);
    const other = { ...scene, objects: shuffled(scene.objects, random) };
    assert.ok((await picture(scene)).equals(await picture(other)), `seed ${seed}`);
    if (seed > 3) continue;
    for (const algorithm of ['zbuffer', 'warnock']) {
      const by = (s) => picture({ ...s, render: { ...s.render, algorithm } });
      assert.ok((await by(scene)).equals(await by(other)), `seed ${seed}, ${algorithm}`);
    }
  }
});

test('the command draws what the server draws, and warns of glass inside out', async () => {
  const scene = { ...await readJson('glass-inside-out.json'), image: { width: 64, height: 48 } };
  const path = join(folder, 'command.png');
  const { stderr } = await run(scene, 'render', '-o', path);
  assert.match(stderr, /\/objects\/1: the mesh is transparent and wound inside out/);
  assert.ok((await picture(scene)).equals(await readFile(path)));
});

test('glass wound inside out is drawn as if it were not, with a warning that names the object', async () => {
  const scene = await readJson('glass-inside-out.json');
  const right = structuredClone(scene);
  right.meshes.t.indices = reversedIndices(scene.meshes.t.indices);
  assert.deepEqual((await warnings(scene)).map(({ code, pointer }) => [code, pointer]), [['inside_out_glass', '/objects/1']]);
  assert.deepEqual(await codes(right), []);
  assert.ok((await picture(scene)).equals(await picture(right)));
});

test('mirrored copies of right glass need no warning, of wrong glass they do', async () => {
  const scene = await readJson('glass-inside-out.json');
  const right = structuredClone(scene);
  right.meshes.t.indices = reversedIndices(scene.meshes.t.indices);
  for (const s of [scene, right]) {
    s.objects[1].scale = [-1, 1, 1];
    s.objects.push({ ...s.objects[1], scale: [1, -1, -1], translate: [1.2, 1.2, 0] });
  }
  assert.deepEqual(await codes(right), []);
  assert.deepEqual(await codes(scene), ['inside_out_glass', 'inside_out_glass']);
  assert.ok((await picture(scene)).equals(await picture(right)));
});

const joined = (...meshes) => ({
  positions: meshes.flatMap((mesh) => mesh.positions),
  indices: meshes.flatMap((mesh, i) => {
    const first = meshes.slice(0, i).reduce((sum, m) => sum + m.positions.length / 3, 0);
    return mesh.indices.map((v) => v + first);
  }),
});
const moved = (mesh, by, size = 1) =>
  ({ ...mesh, positions: mesh.positions.map((v, i) => size * (v - (i % 3 === 1 ? 0.5 : 0)) + by[i % 3]) });
const insideOut = (mesh) => ({ ...mesh, indices: reversedIndices(mesh.indices) });

test('of several shells in one mesh those inside out are turned, and cavities stay', async () => {
  const scene = await readJson('glass-inside-out.json');
  scene.image = { width: 80, height: 60 };
  const of = (mesh) => ({ ...scene, meshes: { t: mesh } });
  const a = moved(kCube, [0, 0.5, 0], 0.6), b = moved(kCube, [0.8, 0.4, 0], 0.5), hole = moved(kCube, [0, 0.5, 0], 0.3);
  const right = await picture(of(joined(a, b)));
  assert.deepEqual(await codes(of(joined(a, b))), []);
  for (const mesh of [joined(insideOut(a), b), joined(a, insideOut(b)), joined(insideOut(a), insideOut(b))]) {
    assert.deepEqual(await codes(of(mesh)), ['inside_out_glass']);
    assert.ok(right.equals(await picture(of(mesh))));
  }
  const hollow = of(joined(a, insideOut(hole)));
  assert.deepEqual(await codes(hollow), []);
  assert.ok(!(await picture(hollow)).equals(await picture(of(a))));
  const wrong = of(joined(insideOut(a), hole));
  assert.deepEqual(await codes(wrong), ['inside_out_glass']);
  assert.ok((await picture(wrong)).equals(await picture(hollow)));
});

test('two cubes of one mesh with a face in common are one piece of glass', async () => {
  const scene = {
    image: { width: 1, height: 1 }, ambient: 0, lights: [], background: { bottom: 1, top: 1 }, render: { weight_cutoff: 0 },
    camera: { position: [0.13, 3, 0.21], target: [0.1, 0, 0.1], fov_y_deg: 0.001 },
    materials: { g: { diffuse: 0, transmission: 0.9 } },
    objects: [{ type: 'mesh', mesh: 't', material: 'g' }],
  };
  const low = moved(kCube, [0, 0, 0]), high = moved(kCube, [0, 1, 0]);
  for (const mesh of [joined(low, high), joined(high, low), insideOut(joined(low, high))]) {
    const { color_linear, rays } = await explain({ ...scene, meshes: { t: mesh } });
    near(color_linear[0], 0.9 * 0.9, 1e-15, 'the top and the bottom alone');
    assert.equal(rays.length, 3);
  }
});

// From z = -1 to 1; the outline counter-clockwise, its caps by triangles of corners.
const prism = (outline, cap) => {
  const n = outline.length;
  const walls = outline.flatMap((_, i) => [i, (i + 1) % n, n + i, (i + 1) % n, n + (i + 1) % n, n + i]);
  return { positions: [-1, 1].flatMap((z) => outline.flatMap(([x, y]) => [x, y, z])),
           indices: [...walls, ...reversedIndices(cap), ...cap.map((v) => n + v)] };
};

test('a slit without width in a body of glass is not there', async () => {
  const scene = {
    image: { width: 120, height: 90 }, camera: { position: [7, 5, 8], target: [2, 2, 0], fov_y_deg: 40 },
    render: { samples: 1, shadows: false },  // light is tinted by hidden faces too
    materials: { g: { diffuse: 0, transmission: 0.9 }, f: { diffuse: { checker: { size: 0.5 } } } },
    objects: [{ type: 'plane', point: [0, -0.5, 0], material: 'f' }, { type: 'mesh', mesh: 't', material: 'g' }],
  };
  const slit = prism([[0, 0], [4, 0], [4, 2], [2, 2], [4.5, 2], [4.5, 4], [0, 4]], [0, 1, 3, 1, 2, 3, 0, 3, 6, 3, 4, 6, 4, 5, 6]);
  const whole = prism([[0, 0], [4, 0], [4, 2], [4.5, 2], [4.5, 4], [0, 4]], [0, 1, 2, 0, 2, 5, 2, 3, 4, 2, 4, 5]);
  assert.equal(await differing({ ...scene, meshes: { t: slit } }, { ...scene, meshes: { t: whole } }), 0);
});

test('of two cubes of one mesh with a face in common one inside out is turned, and a facet added both ways changes nothing', async () => {
  const scene = await readJson('glass-inside-out.json');
  scene.image = { width: 60, height: 45 };
  scene.objects[1].scale = 0.6;
  const of = (mesh) => ({ ...scene, meshes: { t: mesh } });
  const low = moved(kCube, [0, 0.5, 0]), high = moved(kCube, [0, 1.5, 0]);
  const right = await picture(of(joined(low, high)));
  for (const mesh of [joined(low, insideOut(high)), joined(insideOut(low), high), joined(insideOut(high), low)]) {
    assert.deepEqual(await codes(of(mesh)), ['inside_out_glass']);
    assert.ok(right.equals(await picture(of(mesh))));
  }
  scene.render.shadows = false;  // light is tinted by hidden faces too
  const one = await picture(of(low));
  for (const facet of [[0, 4, 6], [1, 5, 0], [2, 7, 3]]) {
    const more = { ...low, indices: [...low.indices, ...facet, ...reversedIndices(facet)] };
    assert.deepEqual(await codes(of(more)), []);
    assert.ok(one.equals(await picture(of(more))), `${facet}`);
  }
});

test('an eye where two shells of one mesh overlap is in the glass until it leaves the second', async () => {
  const unit = moved(kCube, [0.5, 0.5, 0.5]);
  const scene = {
    image: { width: 1, height: 1 }, ambient: 0, lights: [], background: { bottom: 1, top: 1 }, render: { weight_cutoff: 0, max_depth: 20 },
    camera: { position: [0.7, 0.5, 0.5], target: [1.7, 0.8, 0.6], fov_y_deg: 0.001 },
    materials: { g: { diffuse: 0, transmission: 0.9, ior: 1.5 } },
    meshes: { t: joined(unit, moved(kCube, [1, 0.5, 0.5])) }, objects: [{ type: 'mesh', mesh: 't', material: 'g' }],
  };
  const orthographic = { ...scene.camera, fov_y_deg: undefined, type: 'orthographic', height: 1e-6 };
  for (const camera of [scene.camera, orthographic]) {
    const { rays } = await explain({ ...scene, camera });
    const [primary, across, out] = rays;
    for (let axis = 0; axis < 3; ++axis) near(across.direction[axis], primary.direction[axis], 1e-12, 'goes straight on');
    near(across.origin[0], 1, 1e-12, 'the face of the first');
    near(out.origin[0], 1.5, 1e-12, 'the face of the second');
    const sine = (ray) => Math.hypot(ray.direction[1], ray.direction[2]);
    near(sine(out), 1.5 * sine(across), 1e-12, 'n sin');
  }
});

test('bodies in one place that differ in normals or pattern alone may stand in any order', async () => {
  const scene = await readJson('glass-inside-out.json');
  scene.image = { width: 64, height: 48 };
  scene.materials.c = { ...scene.materials.g, diffuse: { checker: { size: 0.3 } } };
  const meshes = { sharp: { ...moved(kCube, [0, 0.5, 0]), crease_deg: 0 }, smooth: { ...moved(kCube, [0, 0.5, 0]), crease_deg: 180 } };
  const pairs = [
    [{ type: 'mesh', mesh: 'sharp', material: 'g' }, { type: 'mesh', mesh: 'smooth', material: 'g' }],
    [{ type: 'sphere', radius: 2, scale: 0.5, material: 'c' }, { type: 'sphere', radius: 1, material: 'c' }],
  ];
  for (const objects of pairs)
    assert.ok((await picture({ ...scene, meshes, objects })).equals(await picture({ ...scene, meshes, objects: [...objects].reverse() })));
});

test('a sheet of glass with a back is thin, and says so', async () => {
  const scene = await readJson('glass-inside-out.json');
  const one = { positions: [0, 0, 0, 1, 0, 0.1, 0.2, 1, 0.3], indices: [0, 1, 2] };
  const both = { ...one, indices: [0, 1, 2, 0, 2, 1] };
  assert.deepEqual(await codes({ ...scene, meshes: { t: both } }), ['open_glass']);
  assert.ok((await picture({ ...scene, meshes: { t: both } })).equals(await picture({ ...scene, meshes: { t: one } })));
});

// A surface of revolution with this profile (radius, height), or a torus.
function grid(across, along, at, isClosed) {
  const positions = [], indices = [];
  const rows = isClosed ? along : along + 1;
  for (let j = 0; j < rows; ++j) for (let i = 0; i < across; ++i) positions.push(...at(i / across, j / along));
  for (let j = 0; j < along; ++j) {
    for (let i = 0; i < across; ++i) {
      const a = j * across + i, b = j * across + (i + 1) % across;
      const c = ((j + 1) % rows) * across + i, d = ((j + 1) % rows) * across + (i + 1) % across;
      indices.push(a, c, b, b, c, d);
    }
  }
  return { positions, indices, crease_deg: 180 };
}
const turn = 2 * Math.PI;
const ball = (across, along, [x, y, z] = [1, 1, 1]) => grid(across, along, (u, v) => {
  const s = v === 1 ? 0 : Math.sin(Math.PI * v);
  return [x * s * Math.cos(turn * u), y * Math.cos(Math.PI * v), -z * s * Math.sin(turn * u)];
}, false);

async function assertWhite(scene, what) {
  const m = { ...scene.materials.m, ior: 1, reflection: 0, fresnel: false };
  const white = await picture({ ...scene, materials: { m } });
  assert.ok(white.equals(await picture(scene)), what);
}

test('a smooth ball of glass in a white furnace is white to its rim', async () => {
  await assertWhite(await readJson('smooth-glass-ball-in-furnace.json'), 'the ball of 20 by 10');
});

// What total reflection keeps in the edge of a thin lens comes out after more than 8 surfaces: of a true ellipsoid of
// ior 2.4 more than of one of facets.
test('balls and eggs of coarse and fine facets are white, of any index, at the depth of every day, and lenses beyond it', async () => {
  const base = await readJson('smooth-glass-ball-in-furnace.json');
  const shapes = {
    coarse: ball(6, 4), ball: ball(24, 12), fine: ball(64, 32), egg: ball(24, 12, [0.7, 1.2, 0.7]), lens: ball(32, 16, [1, 0.25, 1]),
  };
  for (const [name, mesh] of Object.entries(shapes)) {
    for (const ior of [1.05, 1.33, 1.5, 2.4, 0.7]) {
      const scene = structuredClone(base);
      scene.image = { width: 80, height: 80 };
      scene.render = { samples: 4, max_depth: name === 'lens' ? 60 : 8, weight_cutoff: 0 };
      scene.camera.position = [0, 1.3, 4];
      scene.meshes = { s: mesh };
      scene.materials.m.ior = ior;
      await assertWhite(scene, `${name}, ior ${ior}`);
    }
  }
});
