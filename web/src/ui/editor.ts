/** The text editor: CodeMirror with YAML, in the colours of the page, and problems at their lines. */

import { defaultKeymap, history, historyKeymap, indentLess, indentMore } from "@codemirror/commands";
import { yaml } from "@codemirror/lang-yaml";
import { bracketMatching, foldGutter, foldKeymap, HighlightStyle, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { type Diagnostic, lintGutter, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { EditorState, type Extension, type Text } from "@codemirror/state";
import {
  drawSelection,
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  keymap,
  lineNumbers,
} from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { hasWindowsLines, pathOf, type TextProblem } from "../model/scenario";

const colour = (light: string, dark: string) =>
  `light-dark(var(--mantine-color-${light}), var(--mantine-color-${dark}))`;

const COLOURS = HighlightStyle.define([
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: colour("blue-9", "blue-3") },
  { tag: [tags.string, tags.special(tags.string)], color: "light-dark(#1f6b2d, var(--mantine-color-green-4))" },
  { tag: tags.comment, color: colour("gray-7", "dark-1"), fontStyle: "italic" },
  { tag: [tags.labelName, tags.typeName, tags.meta], color: colour("grape-8", "grape-3") },
  { tag: [tags.keyword, tags.operatorKeyword, tags.controlKeyword], color: colour("grape-8", "grape-3") },
  { tag: [tags.definition(tags.variableName), tags.definition(tags.className)], color: colour("blue-9", "blue-3") },
  { tag: [tags.number, tags.bool, tags.null], color: "light-dark(#8a3b00, var(--mantine-color-orange-3))" },
]);

const LOOK = EditorView.theme({
  "&": { height: "100%", fontSize: "13px", backgroundColor: "var(--mantine-color-body)", color: "var(--mantine-color-text)" },
  "&.cm-focused": { outline: "2px solid var(--mantine-primary-color-filled)", outlineOffset: "-2px" },
  ".cm-scroller": { fontFamily: "var(--mantine-font-family-monospace)", lineHeight: "1.5" },
  ".cm-gutters": {
    backgroundColor: "light-dark(var(--mantine-color-gray-0), var(--mantine-color-dark-8))",
    color: "var(--mantine-color-dimmed)",
    borderRight: "1px solid var(--mantine-color-default-border)",
  },
  ".cm-activeLine": { backgroundColor: "light-dark(rgba(0, 0, 0, 0.03), rgba(255, 255, 255, 0.04))" },
  ".cm-activeLineGutter": { backgroundColor: "var(--mantine-color-default-hover)", color: "var(--mantine-color-text)" },
  ".cm-cursor": { borderLeftColor: "var(--mantine-color-text)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": {
    backgroundColor: "light-dark(var(--mantine-color-blue-1), var(--mantine-color-blue-9))",
  },
  ".cm-tooltip, .cm-panels": {
    backgroundColor: "var(--mantine-color-body)",
    color: "var(--mantine-color-text)",
    border: "1px solid var(--mantine-color-default-border)",
  },
  ".cm-tooltip-autocomplete ul li[aria-selected]": {
    backgroundColor: "light-dark(var(--mantine-color-blue-1), var(--mantine-color-blue-9))",
    color: "var(--mantine-color-text)",
  },
  ".cm-completionDetail": { color: "var(--mantine-color-dimmed)", fontStyle: "normal" },
  ".cm-textfield, .cm-button": {
    backgroundColor: "var(--mantine-color-default)",
    backgroundImage: "none",
    color: "var(--mantine-color-text)",
    borderColor: "var(--mantine-color-default-border)",
  },
});

interface Asked {
  text: string;
  /** What a screen reader says of it. */
  label: string;
  onText: (text: string) => void;
  /** What the text is written in, and what helps with that; YAML where nothing is said. */
  language?: Extension;
  readOnly?: boolean;
}

/** An editor in a place of the page. Tab leaves it, as everywhere; Ctrl+] and Ctrl+[ indent. */
export function openEditor(place: HTMLElement, { text, label, onText, language = yaml(), readOnly = false }: Asked): EditorView {
  const view: EditorView = new EditorView({
    parent: place,
    state: EditorState.create({
      doc: text,
      extensions: [language, EditorState.readOnly.of(readOnly), ...extensions(text, label), telling(onText)],
    }),
  });
  return view;
}

/** The text as it is saved: with the line breaks that it came with. */
export const textOf = (view: EditorView): string => view.state.sliceDoc();

/** Another text in place of all, as one step that can be undone. */
export function replaceAll(view: EditorView, text: string): void {
  view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: view.state.toText(text) } });
}

/** Put the cursor at a place and show it. */
export function goTo(view: EditorView, line: number, column: number): void {
  const at = position(view.state.doc, line, column);
  view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: "center" }) });
  view.focus();
}

/** Mark the lines of problems. */
export function mark(view: EditorView, problems: readonly TextProblem[]): void {
  view.dispatch(setDiagnostics(view.state, problems.map((each) => diagnostic(view.state.doc, each))));
}

function diagnostic(doc: Text, problem: TextProblem): Diagnostic {
  const { line, column, what, value, allowed, remedy } = problem;
  const from = position(doc, line ?? 1, column ?? 1);
  const got = value ? ` (got ${value})` : "";
  const more = [allowed ? `allowed: ${allowed}` : "", remedy].filter(Boolean).map((each) => `; ${each}`);
  const path = pathOf(problem);
  const message = `${path ? `${path}: ` : ""}${what}${got}${more.join("")}`;
  return { from, to: Math.max(from, doc.lineAt(from).to), severity: "error", message };
}

/** A place in a text, or the nearest one: it may have changed since it was told. */
function position(doc: Text, line: number, column: number): number {
  const found = doc.line(Math.min(Math.max(1, line), doc.lines));
  return Math.min(found.from + Math.max(0, column - 1), found.to);
}

const telling = (onText: (text: string) => void): Extension =>
  EditorView.updateListener.of(({ docChanged, view }) => docChanged && onText(textOf(view)));

const extensions = (text: string, label: string): Extension[] => [
  lineNumbers(),
  foldGutter(),
  lintGutter(),
  history(),
  drawSelection(),
  highlightActiveLine(),
  highlightActiveLineGutter(),
  highlightSelectionMatches(),
  bracketMatching(),
  indentUnit.of("  "),
  syntaxHighlighting(COLOURS),
  search({ top: true }),
  LOOK,
  EditorView.contentAttributes.of({ tabindex: "0", "aria-label": label }),
  ...(hasWindowsLines(text) ? [EditorState.lineSeparator.of("\r\n")] : []),
  keymap.of([
    { key: "Mod-]", run: indentMore },
    { key: "Mod-[", run: indentLess },
    ...defaultKeymap,
    ...historyKeymap,
    ...searchKeymap,
    ...foldKeymap,
  ]),
];
