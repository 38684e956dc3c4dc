// SPDX-License-Identifier: Apache-2.0
// Wires the page: scenes and links in, the viewer in the middle, panels and commands around it.
import * as api from './api.js';
import { copy } from './clipboard.js';
import { ComparePanel } from './compare_panel.js';
import { byId } from './dom.js';
import { Editor } from './editor.js';
import { ErrorPanel } from './error_panel.js';
import { FenField } from './fen.js';
import { HeatLayer } from './heat.js';
import { MethodPicker } from './method_picker.js';
import { kNoWords, knownWish, wishAfterEdit, wordsOf } from './methods.js';
import { Panels } from './panels.js';
import { showPlan, showPrediction, showTimings } from './plan.js';
import { RulePicker } from './rule_picker.js';
import { withRule } from './rules.js';
import { findPosition, renderOf, sameCamera, withFen } from './scene_text.js';
import { ScenePicker } from './scenes.js';
import { Superseded } from './session.js';
import { curlCommand, decodeLink, encodeLink, linkWith, stillDocument } from './share.js';
import { showHint, Status } from './status.js';
import { say } from './toast.js';
import { Viewer } from './viewer.js';

const kNeedScene = ['reset', 'link', 'curl', 'download'];  // these buttons mean nothing before there is a picture

const status = new Status();
const hideHint = showHint();
const viewer = new Viewer(byId('picture'), {
  api,
  on: {
    frame: (event) => {
      status.show(event);
      errorPanel.take(event.frame);
      heat.follow(event.frame, event.moving);
      if (!event.frame.isFinal || event.moving) {
        comparePanel.hold({ isMoved: event.moving });
        return;
      }
      comparePanel.rest();
      showTimings(byId('plan-body'), event.frame.timings);
      foretell();
    },
    state: (name, problem) => status.state(name, problem),
    moved: () => {
      hideHint();
      comparePanel.hold({ isMoved: true });
    },
  },
});
const panels = new Panels([
  [{ button: 'scenes-button', panel: 'scenes-panel' }],
  [{ button: 'edit-button', panel: 'edit-panel' }, { button: 'plan-button', panel: 'plan-panel' },
    { button: 'error-button', panel: 'error-panel' }, { button: 'method-button', panel: 'method-panel' }],
]);
const editor = new Editor({ edited: drawEdit });
const fenField = new FenField({ edited: drawFen });
const errorPanel = new ErrorPanel();
const heat = new HeatLayer({ load: (frame) => viewer.errorMap(frame) });
const rulePicker = new RulePicker({ changed: chooseRule });
const methodPicker = new MethodPicker({ changed: chooseMethod, saveLines });
const comparePanel = new ComparePanel({
  api,
  still: () => ({ ...viewer.still, text: shown.text, render: withRule(renderOf(shown.text), rule) }),
});

// What is on show: the scene's file and title (file null once it was edited) and its text as the server took it.
const shown = { file: null, title: 'Your scene', text: null };
let rule = null;  // what ends the picture, as of rules.js; the address keeps it
let method = {};  // what draws the picture, as a wish of methods.js; the address keeps it too
let words = kNoWords;
let scenes = [];
let picker = null;
let latestPrediction = 0;  // number of the last question of foretell()

// Shows the scene whose text `load()` gives in place of the present one; throws what the server has against it.
// `camera`, `keepsView` and `adaptMethod` as of Viewer.
async function open(load, { file = null, title = shown.title, isEdited = false, camera = null, keepsView = false, adaptMethod = (wish) => wish }) {
  status.restart();
  const info = await viewer.open(load, { camera, keepsView, adaptMethod });
  const scene = JSON.parse(info.text);
  Object.assign(shown, { file, title, text: info.text });
  expectRules(scene.render);
  setMethod(viewer.still.method);
  byId('scene-title').textContent = isEdited ? `${title}, edited` : title;
  byId('picture').setAttribute('aria-label', `Picture: ${title}`);
  document.title = `${title} · Tilelight`;
  for (const name of kNeedScene) byId(`${name}-button`).disabled = false;
  picker?.mark(file);
  fenField.show(findPosition(scene));
  showPlan(byId('plan-body'), info);
}

// What ends the picture from here on, under the scene's own rules.
function expectRules(render) {
  status.expect(withRule(render, rule));
  errorPanel.expect(withRule(render, rule));
  rulePicker.setScene(render);
}

function setRule(next) {
  rule = next;
  viewer.setRule(rule);
  rulePicker.show(rule);
  if (shown.text) expectRules(JSON.parse(shown.text).render);
}

function chooseRule(next) {
  setRule(next);
  drawAgain();
}

// `wish` as of methods.js; of words that the server does not know it keeps nothing.
function setMethod(wish) {
  method = knownWish(wish, words);
  viewer.setMethod(method);
  methodPicker.show(renderOf(shown.text), method);
}

function chooseMethod(wish) {
  setMethod(wish);
  drawAgain();
}

// The same view under another rule or by another method; the address follows.
function drawAgain() {
  viewer.drawAgain();
  if (shown.text) status.again();
  keepInAddress(location.hash);
}

function keepInAddress(hash) {
  const link = linkWith(hash, { rule, method });
  if (link !== (location.hash || '#')) history.replaceState(null, '', link);
}

// As open(), for a scene that somebody else wrote: what goes wrong is said in the notice.
async function openOrExplain(load, options) {
  try {
    await open(load, options);
    editor.show(shown.text);
  } catch (error) {
    if (error instanceof Superseded) return;
    status.broken(`This scene cannot be drawn: ${error.message}`, () => openOrExplain(load, options));
  }
}

// Asks what the picture on show should have cost. A question to the server for those who look at the plan only; of
// several answers on the way only that to the last question counts.
async function foretell() {
  if (byId('plan-panel').hidden || !shown.text) return;
  const question = ++latestPrediction;
  const { predicted } = await api.planOf(stillDocument(shown.text, viewer.still)).catch(() => ({}));
  if (predicted && question === latestPrediction) showPrediction(byId('plan-body'), predicted);
}

function pick(scene) {
  keepInAddress(`scene=${scene.file.replace(/\.json$/, '')}`);
  openOrExplain(() => api.loadScene(scene.file), { file: scene.file, title: scene.title });
  if (matchMedia('(max-width: 720px)').matches) panels.close('scenes-panel');
}

// Shows what the user wrote. Returns what the server has against it, or null if something newer is under way.
async function tryText(text) {
  const keepsView = shown.text !== null && sameCamera(text, shown.text);
  const before = renderOf(shown.text ?? text);
  try {
    await open(() => text, { keepsView, isEdited: true, adaptMethod: (wish) => wishAfterEdit(wish, before, renderOf(text)) });
    keepInAddress(location.hash);
    return [];
  } catch (error) {
    if (error instanceof Superseded) return null;
    if (error instanceof api.Problem && error.errors.length) return error.errors;
    return [{ pointer: '', detail: error.message }];
  }
}

async function drawEdit(text) {
  const errors = await tryText(text);
  if (errors) editor.judge(text, errors);
}

// A FEN is written into the text that is being edited, whatever state that is in, so that neither is lost.
async function drawFen(fen) {
  const text = withFen(editor.text, fen);
  if (text === null) {
    fenField.showError({ detail: 'the scene below has no position to put this in' });
    return;
  }
  editor.amend(text);
  const errors = await tryText(text);
  if (!errors) return;
  const inField = errors.filter(({ pointer }) => pointer.endsWith('/fen')).slice(0, 1);
  fenField.showError(inField[0]);
  editor.judge(text, errors, inField);
}

const savePng = () => save(byId('download-button'), 'png', (still) => api.renderImage(still));

function saveLines() {
  return save(byId('lines-button'), 'svg', async (still) => (await api.renderStill(still, { format: 'image/svg+xml' })).blob);
}

// Saves what `draw(document)` gives for the view on show.
async function save(button, suffix, draw) {
  if (button.getAttribute('aria-busy') === 'true') return;  // one at a time: a render may take the server minutes
  button.setAttribute('aria-busy', 'true');
  try {
    const still = stillDocument(shown.text, viewer.still);
    const url = URL.createObjectURL(await draw(still));
    const link = document.createElement('a');
    const name = shown.title.toLowerCase().replace(/[^a-z0-9]+/g, '-');
    link.href = url;
    link.download = `tilelight-${name}-${still.image.width}x${still.image.height}.${suffix}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 60_000);
  } catch (error) {
    say(error.message, 'warning');
  }
  button.removeAttribute('aria-busy');
}

async function copyLink() {
  const scene = shown.file?.replace(/\.json$/, '');
  const hash = await encodeLink({ scene, text: scene ? null : shown.text, camera: viewer.camera, rule, method });
  history.replaceState(null, '', hash);
  await copy(location.href, 'Link');
}

function copyCurl() {
  return copy(curlCommand(api.kBaseUrl, stillDocument(shown.text, viewer.still)), 'curl command');
}

// Opens what the address asks for. If there is no such thing, the first scene comes as it is, and a word that it did.
async function openLink() {
  const { scene, text, camera, rule: asked, method: wish, isDamaged } = await decodeLink(location.hash);
  setRule(asked);
  setMethod(wish);
  if (text) {
    await openOrExplain(() => text, { title: 'Shared scene', camera });
    return;
  }
  const found = scenes.find(({ file }) => file === `${scene}.json`);
  const isLost = isDamaged || (scene !== null && !found);
  const { file, title } = found ?? scenes[0];
  await openOrExplain(() => api.loadScene(file), { file, title, camera: isLost ? null : camera });
  if (isLost) say(`${isDamaged ? 'The link is damaged' : `There is no scene “${scene}”`}: this is ${title}`, 'warning');
}

async function start() {
  try {
    [scenes, words] = await Promise.all([api.listScenes(), api.sceneSchema().then(wordsOf)]);
  } catch (error) {
    status.broken(error.message, start);
    return;
  }
  methodPicker.setWords(words);
  comparePanel.setWords(words);
  picker = new ScenePicker({ api, list: byId('scene-list'), scenes, pick });
  api.limits().then((limits) => rulePicker.setLimits(limits), () => {});  // without them the server is the judge
  addEventListener('hashchange', openLink);
  await openLink();
}

byId('scenes-panel').addEventListener('panel-open', () => picker?.drawThumbnails());
byId('plan-panel').addEventListener('panel-open', foretell);
byId('reset-button').addEventListener('click', () => viewer.reset());
byId('picture').addEventListener('keydown', (event) => {
  const isPlain = !event.altKey && !event.ctrlKey && !event.metaKey && !event.repeat;
  if (isPlain && event.key.toLowerCase() === 'h') heat.toggle();
  if (isPlain && event.key.toLowerCase() === 'c') comparePanel.toggle();
});
// What lies over the picture is one thing at a time.
for (const [one, other] of [['heat-toggle', 'compare-toggle'], ['compare-toggle', 'heat-toggle']]) {
  byId(one).addEventListener('change', () => byId(one).checked && byId(other).checked && byId(other).click());
}
byId('link-button').addEventListener('click', copyLink);
byId('curl-button').addEventListener('click', copyCurl);
byId('download-button').addEventListener('click', savePng);
addEventListener('pageshow', (event) => event.persisted && location.reload());
start();
