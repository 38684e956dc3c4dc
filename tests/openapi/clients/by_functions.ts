// SPDX-License-Identifier: Apache-2.0
// Stores a scene, renders it as a job, waits, and fetches the picture: by the functions of Hey API's openapi-ts.
import { createRender, getRender, getRenderImage, storeScene } from './functions/sdk.gen';
import { client } from './functions/client.gen';
import type { Scene, State } from './functions/types.gen';

export async function renderABall(baseUrl: string) {
  client.setConfig({ baseUrl });
  const ball: Scene = {
    objects: [{ type: 'sphere', center: [0, 1, 0], radius: 1 }],
    image: { width: 32, height: 24 },
    render: { samples: 1 },
  };
  const stored = await storeScene({ body: ball });
  const scene = stored.data?.id;
  if (!scene) throw new Error(stored.error?.detail);
  const accepted = await createRender({ body: { scene, camera: { position: [0, 1, 6] } } });
  const id = accepted.data && 'id' in accepted.data ? accepted.data.id : undefined;
  if (!id) throw new Error(accepted.error?.detail);
  let state: State | undefined;
  while (state !== 'done') {
    const job = await getRender({ path: { id }, headers: { Prefer: 'wait=5' } });
    state = job.data?.state;
    if (job.error || state === 'failed' || state === 'cancelled') throw new Error(job.error?.detail ?? state);
  }
  const image = await getRenderImage({ path: { id }, headers: { Accept: 'image/png' } });
  if (!(image.data instanceof Blob)) throw new Error('the picture is no picture');
  return { scene, state, png: await image.data.arrayBuffer() };
}
