// A lesson: its text, its steps, and its knobs, which are parameters of the methods, the scene and the rendering.
import { defaultOf, makeField, readSpec } from './chooser.js';
import { element } from './report/dom.js';
import { lessonOf, lessons } from './lessons.js';

export class LessonPanel {
  /// `choosersOf()` are those of the page by the parts of the state; `go` displays a state.
  constructor(choosersOf, go) {
    Object.assign(this, { choosersOf, go });
    const option = ([value, text]) => element('option', { value }, text);
    this.figures = element('optgroup', { label: 'Figures of the program' });
    this.list = element('select', { 'aria-label': 'Lesson', onchange: () => this.choose(this.list.value) }, option(['', 'Choose a lesson …']),
      element('optgroup', { label: 'Scenes and methods, step by step' }, lessons.map(({ name, title }) => option([name, title]))), this.figures);
    const button = (text, by) => element('button', { type: 'button', onclick: () => this.open(this.lesson, this.step + by) }, text);
    this.title = element('h2'), this.text = element('p', { class: 'lesson-text' }), this.knobs = element('div', { class: 'knobs' });
    this.back = button('‹ Back', -1), this.next = button('Next ›', 1), this.place = element('span', { class: 'label' });
    this.node = element('section', { class: 'card lesson', 'aria-label': 'Lesson', hidden: true }, this.title, this.text, this.knobs,
      element('div', { class: 'row' }, this.back, this.next, this.place, element('button', { type: 'button', onclick: () => this.open(null, 0) }, 'Close')));
  }

  /// Adds the lessons of the catalogue, whose values begin with demo=.
  listFigures(rows) { this.figures.append(...rows.map(({ name }) => element('option', { value: `demo=${name}` }, name))); }

  choose(value) {
    if (value.startsWith('demo=')) this.go({ demo: value.slice(5) });
    else this.open(lessonOf(value) ?? null, 0);
  }

  open(lesson, step) {
    this.go(lesson ? { ...lesson.steps[step].state, lesson: lesson.name, step: step ? String(step + 1) : '' } : {});
  }

  show(state) {
    const lesson = lessonOf(state.lesson), steps = lesson?.steps ?? [];
    this.lesson = lesson, this.step = Math.min(Math.max(0, Number(state.step || 1) - 1), steps.length - 1);
    this.list.value = state.demo ? `demo=${state.demo.split(':')[0]}` : lesson?.name ?? '';
    this.node.hidden = !lesson;
    if (!lesson) return;
    this.title.textContent = lesson.title;
    this.text.textContent = steps[this.step].text;
    this.place.textContent = steps.length > 1 ? `${this.step + 1} of ${steps.length}` : '';
    this.back.hidden = this.next.hidden = steps.length < 2;
    this.back.disabled = this.step === 0, this.next.disabled = this.step === steps.length - 1;
    if (!this.knobs.contains(document.activeElement)) this.knobs.replaceChildren(...steps[this.step].knobs.map((knob) => this.field(knob[0], knob[1], knob[2], state)).filter(Boolean));
  }

  /// The field of a parameter, if the method of the state has it; `range` changes its limits.
  field(part, name, range, state) {
    const chooser = this.choosersOf()[part], side = part === 'scene' ? '' : part.at(-1).toUpperCase();
    const field = part.startsWith('look') ? chooser.field(name, `knob-${part}`) : this.param(chooser, part, name, range, state);
    if (!field) return null;
    if (side) field.querySelector('label').prepend(element('span', { class: 'mark' }, side));
    return field;
  }

  /// The field of a parameter of a scene or a method.
  param(chooser, part, name, range, state) {
    const { name: rowName, given } = readSpec(state[part]), whole = chooser.rows.find((row) => row.name === rowName)?.params.find((p) => p.name === name);
    if (!whole) return null;
    const param = { ...whole, ...range };
    return makeField(param, `knob-${part}`, given.get(name) ?? defaultOf(param), (value) => chooser.set(param, value));
  }
}
