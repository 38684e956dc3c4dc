// SPDX-License-Identifier: Apache-2.0
// Stores a scene, renders it as a job, waits, and fetches the picture: by the types of openapi-typescript.
import createClient from 'openapi-fetch';
import type { components, paths } from './types';

export async function renderABall(baseUrl: string) {
  const client = createClient<paths>({ baseUrl });
  const ball: components['schemas']['Scene'] = {
    objects: [{ type: 'sphere', center: [0, 1, 0], radius: 1 }],
    image: { width: 32, height: 24 },
    render: { samples: 1 },
  };
  const stored = await client.POST('/v1/scenes', { body: ball });
  const scene = stored.data?.id;
  if (!scene) throw new Error(stored.error?.detail);
  const accepted = await client.POST('/v1/renders', { body: { scene, camera: { position: [0, 1, 6] } } });
  const id = accepted.data && typeof accepted.data === 'object' ? accepted.data.id : undefined;
  if (!id) throw new Error(accepted.error?.detail);
  const path = { id };
  let state: components['schemas']['State'] | undefined;
  while (state !== 'done') {
    const job = await client.GET('/v1/renders/{id}', { params: { path, header: { Prefer: 'wait=5' } } });
    state = job.data?.state;
    if (job.error || state === 'failed' || state === 'cancelled') throw new Error(job.error?.detail ?? state);
  }
  const image = await client.GET('/v1/renders/{id}/image',
    { params: { path, header: { Accept: 'image/png' } }, parseAs: 'arrayBuffer' });
  return { scene, state, png: image.data };
}
