// SPDX-License-Identifier: Apache-2.0
// The choice of what ends a picture: as the scene says, or one rule with a number from a few or of one's own.
import { byId, el } from './dom.js';
import { describeRules, kRules, readRule } from './rules.js';

export class RulePicker {
  #input = byId('rule-number');
  #error = byId('rule-error');
  #presets = byId('rule-presets');
  #radios = document.getElementsByName('rule');
  #rule = null;
  #limits = {};
  #changed;

  // `changed(rule)` is called with every new choice.
  constructor({ changed }) {
    this.#changed = changed;
    for (const radio of this.#radios) {
      radio.addEventListener('change', () => this.#choose(radio.value in kRules ? { key: radio.value, value: kRules[radio.value].first } : null));
    }
    this.#input.addEventListener('change', () => this.#read(this.#input.value));
  }

  setLimits(limits) {
    this.#limits = limits;
  }

  // `render` of the scene on show, for the words about it.
  setScene(render) {
    byId('rule-scene').textContent = `This scene asks for ${describeRules(render)}.`;
  }

  show(rule) {
    this.#rule = rule;
    for (const radio of this.#radios) radio.checked = radio.value === (rule?.key ?? 'scene');
    byId('rule-scene').hidden = Boolean(rule);
    byId('rule-own').hidden = !rule;
    this.#complain('');
    if (!rule) return;
    const { unit, factor, presets } = kRules[rule.key];
    const number = Number((rule.value / factor).toPrecision(6));
    this.#input.value = String(number);
    byId('rule-unit').textContent = unit;
    if (this.#presets.dataset.key !== rule.key) this.#offer(rule.key, presets);
    for (const button of this.#presets.children) button.setAttribute('aria-pressed', String(Number(button.value) === number));
  }

  #offer(key, presets) {
    this.#presets.dataset.key = key;
    this.#presets.replaceChildren(...presets.map((preset) => {
      const button = el('button', { class: 'chip', type: 'button', value: preset }, key === 'time_ms' ? `${preset} s` : String(preset));
      button.addEventListener('click', () => this.#read(button.value));
      return button;
    }));
  }

  #read(text) {
    const { rule, error } = readRule(this.#rule.key, text, { limits: this.#limits });
    if (rule) this.#choose(rule);
    else this.#complain(error);
  }

  #choose(rule) {
    const isSame = rule?.key === this.#rule?.key && rule?.value === this.#rule?.value;
    this.show(rule);
    if (!isSame) this.#changed(rule);
  }

  #complain(error) {
    this.#error.textContent = error;
    this.#input.setAttribute('aria-invalid', String(Boolean(error)));
    if (error) this.#error.scrollIntoView({ block: 'nearest' });
  }
}
