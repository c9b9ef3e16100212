/** A button that opens what is chosen less often; it closes by Escape, and by a click elsewhere. */
import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";

interface Props {
  title: string;
  /** For those to whom the title does not say enough. */
  label?: string;
  class?: string;
  children: ComponentChildren;
}

export function Menu({ title, label = title, children, ...of }: Props) {
  const [isOpen, setOpen] = useState(false);
  const root = useRef<HTMLDivElement>(null);
  const button = useRef<HTMLButtonElement>(null);
  useEffect(() => {
    if (!isOpen) {
      return undefined;
    }
    const leave = ({ target }: Event) => {
      if (target instanceof Node && !root.current?.contains(target)) {
        setOpen(false);
      }
    };
    const end = new AbortController();
    window.addEventListener("pointerdown", leave, { signal: end.signal });
    window.addEventListener("focusin", leave, { signal: end.signal });
    return () => end.abort();
  }, [isOpen]);
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key === "Escape" && isOpen) {
      event.stopPropagation();
      setOpen(false);
      button.current?.focus();
    }
  };
  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: keys of what is inside are heard on their way out
    <div class={`menu ${of.class ?? ""}`} ref={root} onKeyDown={onKeyDown}>
      <button
        type="button"
        class="menu-button"
        aria-label={label}
        aria-expanded={isOpen}
        ref={button}
        onClick={() => setOpen(!isOpen)}
      >
        {title}
      </button>
      {isOpen && <div class="menu-body">{children}</div>}
    </div>
  );
}
