/** The state of one figure that stands by itself, and its questions to the scene that it shares with others. */
import { batch, computed, effect, signal } from "@preact/signals";
import { Inquiry } from "../app/selection/inquiry";
import { DEGREE } from "../shared/linear";
import { formatSelection, parseSelection, type Selection } from "../shared/selection";
import {
  type Figure,
  type FigureActions,
  NO_DETAIL,
  type Resumed,
  type SelectionDetail,
} from "../stages/figure";
import { FIRST_STATE, type FigureState } from "./figureState";
import type { SharedScene } from "./sharedScene";

const NOTHING_RESUMED: Resumed = { thetaDeg: null, point: null };

export class FigureStore {
  readonly #scene: SharedScene;
  readonly #selection = signal<Selection | null>(null);
  readonly #detail = signal<SelectionDetail>(NO_DETAIL);
  readonly #view = signal<number | null>(null);
  readonly #plane = signal(0);
  readonly #isReady = signal(false);
  readonly #inquiry: Inquiry;
  readonly #actions: FigureActions;
  #resumed: Resumed = NOTHING_RESUMED;
  #ends: (() => void)[] = [];

  /** @param begin what is selected while a state says nothing of it */
  constructor(scene: SharedScene, begin: (figure: Figure) => Selection | null, state: FigureState) {
    this.#scene = scene;
    this.#inquiry = new Inquiry({
      selection: () => this.#selection.peek(),
      results: () => scene.state.peek().results,
      detail: () => this.#detail.peek(),
      setDetail: (detail) => {
        this.#detail.value = detail;
      },
      ask: (call, ...of) => scene.ask(call, ...of),
      takeResumed: () => {
        const of = this.#resumed;
        this.#resumed = NOTHING_RESUMED;
        return of;
      },
    });
    this.#actions = {
      select: (picked) => {
        this.#selection.value = picked;
      },
      compareAt: (candidate, at) => {
        const { at: before, isMoved } = this.#detail.peek();
        void this.#inquiry.compareAt(candidate, at, isMoved || at !== before || candidate > 0);
      },
      turnTo: (theta) => void this.#inquiry.turnTo(theta),
      showView: (view) => {
        this.#view.value = view;
      },
      showPlane: (index) => {
        this.#plane.value = index;
      },
      openView: null,
    };
    this.goTo(state);
    let isBegun = state.select !== null;
    let last: readonly unknown[] = [];
    this.#ends.push(
      effect(() => {
        if (!this.#isReady.value) {
          return;
        }
        if (!isBegun) {
          isBegun = true;
          this.#selection.value ??= begin(this.figure.peek());
        }
        // Stages that other figures need change results that this one does not ask about.
        const { matching, halfPlanes } = scene.state.value.results;
        const now = [this.#selection.value, matching, halfPlanes];
        if (now.some((one, i) => one !== last[i])) {
          last = now;
          void this.#inquiry.follow();
        }
      }),
    );
  }

  /** The stages that the figure shows have run. */
  begin(): void {
    this.#isReady.value = true;
  }

  get isReady(): boolean {
    return this.#isReady.value;
  }

  /** Drawn anew when it changes. */
  readonly figure = computed<Figure>(() => {
    const { scene, images, results, params } = this.#scene.state.value;
    return {
      scene,
      images,
      results,
      params,
      selection: this.#selection.value,
      detail: this.#detail.value,
      view: this.#view.value ?? 0,
      plane: this.#plane.value,
      inText: true,
      act: this.#actions,
    };
  });

  /** What a link, an event or an attribute says of the figure. */
  readonly state = computed<FigureState>(() => {
    const { isTurned, theta, isMoved, candidate, at } = this.#detail.value;
    const picked = this.#selection.value;
    return {
      select: picked === null ? null : formatSelection(picked),
      theta: isTurned ? Math.round((10 * theta) / DEGREE) / 10 : null,
      point: isMoved ? [candidate, Math.round(1000 * at) / 1000] : null,
      view: this.#view.value,
      plane: this.#plane.value === 0 ? null : this.#plane.value,
    };
  });

  /** Takes on what a state says; of what it leaves open, the figure stays as it is. */
  goTo(state: Partial<FigureState>): void {
    const { select, theta, point, view, plane } = { ...FIRST_STATE, ...state };
    const picked = parseSelection(select);
    const isOther = picked !== null && select !== this.state.peek().select;
    batch(() => {
      this.#view.value = view ?? this.#view.peek();
      this.#plane.value = plane ?? this.#plane.peek();
      if (isOther || this.#detail.peek() === NO_DETAIL) {
        this.#resumed = { thetaDeg: theta, point };
        this.#selection.value = picked ?? this.#selection.peek();
        return;
      }
      if (theta !== null) {
        void this.#inquiry.turnTo(theta * DEGREE);
      }
      if (point !== null) {
        void this.#inquiry.compareAt(...point, true);
      }
    });
  }

  end(): void {
    for (const end of this.#ends) {
      end();
    }
    this.#ends = [];
  }
}
