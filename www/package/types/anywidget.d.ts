/** A module for anywidget: `_esm = pathlib.Path("anywidget.js")`. */
interface Model {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(event: string, listener: () => void): void;
  off(event: string, listener: () => void): void;
}

declare const widget: {
  /** Draws the figure that the model's traits describe; returns what ends it. */
  render(of: { model: Model; el: HTMLElement }): () => void;
};
export default widget;
