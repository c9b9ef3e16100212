/** A field for a short answer, which Enter checks. */

interface Props {
  label: string;
  written: string;
  onWritten: (written: string) => void;
  onCheck: () => void;
}

export function AnswerField({ label, written, onWritten, onCheck }: Props) {
  return (
    <form
      class="row answer"
      onSubmit={(event) => {
        event.preventDefault();
        onCheck();
      }}
    >
      <label>
        <span>{label}</span>
        <input
          type="text"
          autocomplete="off"
          spellcheck={false}
          value={written}
          onInput={(event) => onWritten(event.currentTarget.value)}
          // The keys of slides are digits and letters here.
          onKeyDown={(event) => event.stopPropagation()}
        />
      </label>
      <button type="submit" class="primary">
        Check
      </button>
    </form>
  );
}
