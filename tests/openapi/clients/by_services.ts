// SPDX-License-Identifier: Apache-2.0
// Stores a scene, renders it as a job, waits, and fetches the picture: by the services of openapi-typescript-codegen.
import { OpenAPI, RendersService, ScenesService } from './services';
import type { Render, Scene } from './services';

export async function renderABall(baseUrl: string) {
  OpenAPI.BASE = baseUrl;
  const ball: Scene = {
    objects: [{ type: 'sphere', center: [0, 1, 0], radius: 1 }],
    image: { width: 32, height: 24 },
    render: { samples: 1 },
  };
  const { id: scene } = await ScenesService.storeScene(ball) as { id: string };
  const accepted = await RendersService.createRender({ scene, camera: { position: [0, 1, 6] } }) as Render;
  const id = accepted.id;
  if (!id) throw new Error('the job has no id');
  let state = accepted.state;
  while (state !== 'done') {
    const job = await RendersService.getRender(id, 'wait=5') as Render;
    state = job.state;
    if (state === 'failed' || state === 'cancelled') throw new Error(state);
  }
  const image = await RendersService.getRenderImage(id, 'image/png') as Blob;
  return { scene, state, png: await image.arrayBuffer() };
}
