/** What follows from a selection: a figure asks the core about the thing that was picked. */
import { questionOf } from "../../kinds/kinds";
import type { Question } from "../../kinds/parts/kind";
import type { Args, CallName, Result } from "../../shared/calls";
import type { SideTrace } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { NO_DETAIL, type Resumed, type SelectionDetail } from "../../stages/figure";
import type { Results } from "../../stages/list";

/** Whose selection it is, and whom it asks. */
interface Inquirer {
  selection(): Selection | null;
  results(): Results;
  detail(): SelectionDetail;
  setDetail(detail: SelectionDetail): void;
  /** Null where the core cannot answer. */
  ask<K extends CallName>(call: K, ...of: Args<K>): Promise<Result<K> | null>;
  /** Where a link says that the selection is to be shown; once. */
  takeResumed(): Resumed;
}

export class Inquiry {
  readonly #of: Inquirer;
  readonly #running = new Set<string>();
  readonly #waiting = new Map<string, () => Promise<void>>();

  constructor(of: Inquirer) {
    this.#of = of;
  }

  /** Nothing of the last selection stays. */
  begin(first: Partial<SelectionDetail> = {}): void {
    this.#of.setDetail({ ...NO_DETAIL, ...first });
  }

  /** Asks about the present selection. */
  async follow(): Promise<void> {
    const question = this.#question();
    if (question === null) {
      this.begin();
    } else if (question.about === "segment") {
      await this.#askAboutSegment(question);
    } else {
      await this.#askAboutSide(question);
    }
  }

  /** Compares the selected segment with another candidate, or at another of its points; `isMoved` when the reader moved it. */
  async compareAt(candidate: number, at: number, isMoved = this.#of.detail().isMoved): Promise<void> {
    this.#change({ candidate, at, isMoved });
    const picked = this.#of.selection();
    const question = this.#question();
    const found = this.#of.detail().story?.candidates[candidate];
    if (question?.about !== "segment" || found === undefined) {
      this.#change({ correspondence: null });
      return;
    }
    await this.#latest("correspondence", async () => {
      const { view, index } = question;
      const answer = await this.#of.ask("correspondence", view, index, found.view, found.segment, at);
      if (this.#of.selection() === picked) {
        this.#change({ correspondence: answer });
      }
    });
  }

  /** Turns the half-plane of the selected side to an angle, radians; `isByHand` when the reader does it. */
  async turnTo(theta: number, isByHand = true): Promise<void> {
    this.#change({ theta, isTurned: isByHand });
    const { side } = this.#of.detail();
    if (side === null) {
      return;
    }
    await this.#latest("warped", async () => {
      const { theta: wanted } = this.#of.detail();
      const warped = await this.#of.ask("warped", side.line, side.side === "left", wanted);
      if (this.#of.detail().side === side) {
        this.#change({ warped });
      }
    });
  }

  #question(): Question | null {
    return questionOf(this.#of.selection(), this.#of.results());
  }

  #change(part: Partial<SelectionDetail>): void {
    this.#of.setDetail({ ...this.#of.detail(), ...part });
  }

  async #askAboutSegment({ view, index }: Extract<Question, { about: "segment" }>): Promise<void> {
    const story = await this.#of.ask("segmentStory", view, index);
    const now = this.#question();
    if (now?.about === "segment" && now.view === view && now.index === index) {
      this.begin({ story });
      const point = story === null ? null : this.#of.takeResumed().point;
      await this.compareAt(point?.[0] ?? 0, point?.[1] ?? NO_DETAIL.at, point !== null);
    }
  }

  async #askAboutSide({ line, side }: Extract<Question, { about: "side" }>): Promise<void> {
    const found = await this.#of.ask("side", line, side === "left");
    const now = this.#question();
    if (now?.about === "side" && now.line === line && now.side === side) {
      const best = bestTheta(found, this.#of.results());
      this.begin({ side: found, theta: best });
      const thetaDeg = found === null ? null : this.#of.takeResumed().thetaDeg;
      await this.turnTo(thetaDeg === null ? best : (thetaDeg * Math.PI) / 180, thetaDeg !== null);
    }
  }

  /** Runs a task, or, while one of its kind runs, the newest one after it: a drag asks no more than is answered. */
  async #latest(kind: string, task: () => Promise<void>): Promise<void> {
    if (this.#running.has(kind)) {
      this.#waiting.set(kind, task);
      return;
    }
    this.#running.add(kind);
    try {
      await task();
    } finally {
      this.#running.delete(kind);
    }
    const next = this.#waiting.get(kind);
    if (next !== undefined) {
      this.#waiting.delete(kind);
      await this.#latest(kind, next);
    }
  }
}

/** The angle of the half-plane, or of the highest sample where there is none; radians. */
export function bestTheta(side: SideTrace | null, { halfPlanes }: Pick<Results, "halfPlanes">): number {
  if (side === null) {
    return 0;
  }
  const own = halfPlanes?.find((halfPlane) => halfPlane.line === side.line && halfPlane.side === side.side);
  if (own !== undefined) {
    return own.theta;
  }
  const { thetas, similarity } = side.curve;
  const highest = Math.max(0, ...similarity);
  return highest > 0 ? (thetas[similarity.indexOf(highest)] ?? 0) : 0;
}
