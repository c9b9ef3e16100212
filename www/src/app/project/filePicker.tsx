/** How files come: chosen in a dialog, as a folder, or dropped anywhere on the page. One place of the page has it at a time. */
import { useEffect, useRef, useState } from "preact/hooks";
import { notify } from "../state/notices";
import { takeFiles } from "./arrivals";
import { hasFolderPicker, pickFolder } from "./folders";
import { droppedFiles, pickedFiles } from "./inputFiles";

export function useFilePicker() {
  const isOver = useFileDrop();
  const fileInput = useRef<HTMLInputElement>(null);
  const folderInput = useRef<HTMLInputElement>(null);
  const onPick = (event: Event) => {
    const input = event.currentTarget as HTMLInputElement;
    const picked = pickedFiles(input.files ?? new DataTransfer().files);
    input.value = "";
    void takeFiles(picked);
  };
  return {
    isOver,
    openFiles: () => fileInput.current?.click(),
    openFolder: () => void openFolder(folderInput.current),
    inputs: (
      <>
        <input ref={fileInput} type="file" multiple hidden data-testid="file-input" onChange={onPick} />
        <input
          ref={folderInput}
          type="file"
          multiple
          hidden
          onChange={onPick}
          {...({ webkitdirectory: true } as object)}
        />
      </>
    ),
  };
}

/** Asks for a folder in the way that lets the page read it again after a reload, where the browser has that. */
async function openFolder(input: HTMLInputElement | null): Promise<void> {
  if (!hasFolderPicker()) {
    input?.click();
    return;
  }
  try {
    const picked = await pickFolder();
    if (picked !== null) {
      await takeFiles(picked);
    }
  } catch (error) {
    notify({ severity: "error", title: "The folder cannot be read", text: String(error) });
  }
}

/** Takes files that are dropped anywhere, which the browser would open in the page's place; tells whether some are held over it. */
function useFileDrop(): boolean {
  const [isOver, setOver] = useState(false);
  useEffect(() => {
    const end = new AbortController();
    const on = (name: "dragover" | "dragleave" | "drop", hear: (event: DragEvent) => void) =>
      window.addEventListener(name, hear, { signal: end.signal });
    on("dragover", (event) => {
      if (event.dataTransfer?.types.includes("Files")) {
        event.preventDefault();
        setOver(true);
      }
    });
    // From part to part of the page nothing is left.
    on("dragleave", ({ relatedTarget }) => {
      if (relatedTarget === null) {
        setOver(false);
      }
    });
    on("drop", (event) => {
      setOver(false);
      if (event.dataTransfer?.types.includes("Files")) {
        event.preventDefault();
        droppedFiles(event.dataTransfer).then(takeFiles, (error: unknown) =>
          notify({ severity: "error", title: "The dropped files cannot be read", text: String(error) }),
        );
      }
    });
    return () => end.abort();
  }, []);
  return isOver;
}
