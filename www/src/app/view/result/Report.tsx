/** The roof report, read in the page: the file as it is saved, in a shadow tree with its own style. */
import { useEffect, useRef, useState } from "preact/hooks";
import { download, outputFile } from "../../session/stageRuns";

const NAME = "roof_report.html";

export function Report() {
  const [html, show] = useState<string | null>(null);
  const open = async (setbacks?: string) => {
    const bytes = await outputFile(NAME, setbacks);
    if (bytes !== null) {
      show(new TextDecoder().decode(bytes));
    }
  };
  return (
    <>
      <button type="button" onClick={() => void open()}>
        Report
      </button>
      {html !== null && <Opened html={html} change={open} close={() => show(null)} />}
    </>
  );
}

interface Props {
  html: string;
  change: (setbacks: string) => Promise<void>;
  close: () => void;
}

function Opened({ html, change, close }: Props) {
  const take = async (input: HTMLInputElement) => {
    const text = await input.files?.[0]?.text();
    if (text !== undefined) {
      // What is wrong with it stands beside the model.
      close();
      await change(text);
    }
  };
  const dialog = useRef<HTMLDialogElement>(null);
  const page = useRef<HTMLDivElement>(null);
  useEffect(() => {
    dialog.current?.showModal();
    const root = page.current?.shadowRoot ?? page.current?.attachShadow({ mode: "open" });
    // What stands in the page's text may have no style of its own: it becomes a sheet, whose rules are about a body.
    const [before = "", style = "", after = ""] = html.split(/<\/?style>/);
    const read = new DOMParser().parseFromString(before + after, "text/html");
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(style.replaceAll(/:root|\bbody\b/g, ":host"));
    if (root !== undefined) {
      root.adoptedStyleSheets = [sheet];
      root.replaceChildren(...read.body.childNodes);
    }
  }, [html]);
  return (
    <dialog ref={dialog} class="report" aria-label="Roof report" onClose={close}>
      <div class="row report-bar">
        <button type="button" onClick={() => void download(NAME)}>
          Save report
        </button>
        <button type="button" onClick={() => void download("roofs.json")}>
          Save as JSON
        </button>
        <label>
          Own setbacks{" "}
          <input type="file" accept=".json" onChange={(event) => void take(event.currentTarget)} />
        </label>
        <button type="button" onClick={() => dialog.current?.close()}>
          Close
        </button>
      </div>
      {
        // biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls is scrolled by keys
        <div class="report-page" ref={page} tabIndex={0} />
      }
    </dialog>
  );
}
