/** Which of several planes, or buildings, a figure shows. */
import { Choice, ListChoice } from "../../parts/Choice";

interface Props {
  names: readonly string[];
  shown: number;
  onShow: (i: number) => void;
}

export function PlaneChoice({ names, shown, onShow }: Props) {
  return names.length > 7 ? (
    <ListChoice title="Plane" names={names} shown={shown} onShow={onShow} />
  ) : (
    <Choice legend="Plane" choices={names.map((name, i) => [i, name])} chosen={shown} choose={onShow} />
  );
}
