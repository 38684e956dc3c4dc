// SPDX-License-Identifier: Apache-2.0
// `tilelight report --against povray` as a user runs it. What each feature of a scene becomes is tests/unit/pov_test.cpp's.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { inputPath, tilelight } from './harness.mjs';

function hasPovray() {
  try {
    execFileSync('povray', ['--version'], { stdio: 'ignore' });
    return true;
  } catch {
    return false;
  }
}

test('a report has POV-Ray at its best settings, all its rays, and what it draws otherwise', async (t) => {
  if (!hasPovray()) return t.skip('POV-Ray is not installed (Debian: apt install povray)');
  const folder = await mkdtemp(join(tmpdir(), 'tilelight-povray-'));
  t.after(() => rm(folder, { recursive: true }));
  const { code, stderr } = await tilelight('report', inputPath('povray-coloured-highlight.json'), '-o', folder,
    '--against', 'povray', '--samples', '8', '--rounds', '3', '--width', '24', '--height', '18');
  assert.equal(code, 0, stderr);
  const study = JSON.parse(await readFile(join(folder, 'study.json'), 'utf8'));

  const trials = study.peer_trials, front = trials.filter((trial) => trial.pareto);
  for (const method of ['-A', '+AM1', '+AM2'])
    assert.ok(trials.some(({ setting }) => setting.startsWith(method)), `${method} was tried`);
  for (const trial of trials) {
    assert.ok(front.some((best) => best.rmse <= trial.rmse && best.cpu_ms <= trial.cpu_ms), trial.setting);
    assert.ok(trial.spp >= 1, `${trial.setting}: ${trial.spp} rays a pixel`);
  }
  const series = study.series.find(({ name }) => name === 'POV-Ray');
  for (const run of series.runs)
    assert.ok(front.some(({ setting }) => setting === run.setting), `${run.setting} is on the front of the sweep`);
  const least = Math.min(...trials.map(({ rmse }) => rmse));
  assert.ok(series.runs.some(({ error }) => error.rmse <= 1.5 * least), 'the best picture is among the runs');

  const named = study.notes.filter((note) => note.startsWith('POV-Ray draws otherwise: '));
  assert.equal(named.length, 1, named.join('\n'));
  assert.match(named[0], /coloured highlights: /);
  const page = await readFile(join(folder, 'report.html'), 'utf8');
  assert.ok(page.includes("How POV-Ray's settings were chosen"));
  assert.ok(page.includes('coloured highlights: '));
});
