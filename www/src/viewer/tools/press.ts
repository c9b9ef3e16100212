/** What counts as picking: a click, a tap, or a finger that rests. A drag and a second finger do not. */

export interface Place {
  /** CSS pixels from the element's corner. */
  x: number;
  y: number;
  isTouch: boolean;
}

/** A press that moves less, in CSS pixels, picks; fingers are less steady. */
const SLACK_PX = { mouse: 4, touch: 12 } as const;
const LONG_PRESS_MS = 500;

type Pointed = Pick<
  PointerEvent,
  "pointerId" | "pointerType" | "clientX" | "clientY" | "offsetX" | "offsetY"
>;

export class PressWatch {
  readonly #onPress: (at: Place) => void;
  readonly #held = new Set<number>();
  /** Where the press began; null once it is none. */
  #began: { x: number; y: number; at: Place } | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(onPress: (at: Place) => void) {
    this.#onPress = onPress;
  }

  down(event: Pointed): void {
    this.#held.add(event.pointerId);
    this.#forget();
    if (this.#held.size > 1) {
      return;
    }
    const at = placeOf(event);
    this.#began = { x: event.clientX, y: event.clientY, at };
    if (at.isTouch) {
      this.#timer = setTimeout(() => this.#press(at), LONG_PRESS_MS);
    }
  }

  move(event: Pointed): void {
    if (this.#began !== null && this.#isFar(event, this.#began)) {
      this.#forget();
    }
  }

  up(event: Pointed): void {
    this.#held.delete(event.pointerId);
    if (this.#began !== null && !this.#isFar(event, this.#began)) {
      this.#press(placeOf(event));
    }
    this.#forget();
  }

  cancel(event: Pick<Pointed, "pointerId">): void {
    this.#held.delete(event.pointerId);
    this.#forget();
  }

  #press(at: Place): void {
    this.#forget();
    this.#onPress(at);
  }

  #forget(): void {
    clearTimeout(this.#timer);
    this.#began = null;
  }

  #isFar(event: Pointed, began: { x: number; y: number; at: Place }): boolean {
    const slack = began.at.isTouch ? SLACK_PX.touch : SLACK_PX.mouse;
    return Math.hypot(event.clientX - began.x, event.clientY - began.y) > slack;
  }
}

function placeOf({ offsetX, offsetY, pointerType }: Pointed): Place {
  return { x: offsetX, y: offsetY, isTouch: pointerType === "touch" };
}
