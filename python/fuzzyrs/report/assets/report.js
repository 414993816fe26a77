"use strict";

/* Commands are copied by a button; a link into something that is folded up unfolds it. */
(() => {
  for (const button of document.querySelectorAll(".copy")) {
    const command = button.previousElementSibling;
    button.hidden = false;
    button.setAttribute("aria-label", `copy the command ${command.textContent}`);
    button.addEventListener("click", async () => {
      try {
        await navigator.clipboard.writeText(command.textContent);
        button.textContent = "copied";
      } catch {
        /* A browser may forbid it; then the command is marked for the reader's own copying. */
        window.getSelection().selectAllChildren(command);
        button.textContent = "marked";
      }
      window.setTimeout(() => (button.textContent = "copy"), 2000);
    });
  }

  window.addEventListener("beforeprint", () => {
    for (const part of document.querySelectorAll(".claims details")) part.open = true;
  });
})();
