"""HTML pages that are whole in themselves: one place that escapes, one that allows."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterable, Mapping
from html import escape
from importlib import resources
from typing import Any

#: Elements without an end.
_VOID = frozenset({"col", "img", "input", "link", "meta"})


class Html(str):
    """A text that is HTML already; any other text is escaped where it becomes part of a page."""

    __slots__ = ()


def element(name: str, /, *children: str, **attributes: str | int | float | bool | None) -> Html:
    """Return an element.

    Parameters
    ----------
    name : str
        Of the element.
    *children : str
        What is in it; escaped unless it is `Html`.
    **attributes
        `class_` is class, `data_x` is data-x. None and False leave an attribute out, True gives
        it no value.
    """
    said = "".join(_attribute(key, value) for key, value in attributes.items())
    if name in _VOID:
        return Html(f"<{name}{said}>")
    return Html(f"<{name}{said}>{join(children)}</{name}>")


def join(parts: Iterable[str]) -> Html:
    """Return parts one after another, escaped unless they are `Html`."""
    return Html("".join(part if isinstance(part, Html) else escape(part) for part in parts))


def _attribute(key: str, value: str | int | float | bool | None) -> str:
    if value is None or value is False:
        return ""
    key = key.rstrip("_").replace("_", "-")
    return f" {key}" if value is True else f' {key}="{escape(str(value))}"'


def data(value: Any, **attributes: str) -> Html:
    """Return values for a script to read, which no browser runs and no text in them can end."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return element(
        "script", Html(text.replace("<", "\\u003c")), type="application/json", **attributes
    )


def data_uri(kind: str, content: bytes) -> str:
    """Return the address of a file that lies in the page itself."""
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"


def asset(package: str, name: str) -> str:
    """Return a text file of a package."""
    return resources.files(package).joinpath(name).read_text(encoding="utf-8")


def document(
    title: str,
    body: Iterable[str],
    *,
    styles: Iterable[str] = (),
    scripts: Iterable[str] = (),
    about: Mapping[str, str] | None = None,
) -> str:
    """Return a page that needs nothing beside it.

    Its policy lets a browser run the scripts and styles that are named here, show pictures that
    lie in the page, and nothing else: whatever stands in the data, no request leaves the page.

    Parameters
    ----------
    title : str
        Of the window.
    body : iterable of str
        What the page shows; escaped unless it is `Html`.
    styles, scripts : iterable of str
        CSS and JavaScript, after those that every page has.
    about : mapping of str to str, optional
        Names and contents of meta elements.
    """
    style = "\n".join([asset(__name__, "base.css"), *styles])
    script = "\n".join([asset(__name__, "theme.js"), *scripts])
    policy = (
        "default-src 'none'; img-src data:; base-uri 'none'; form-action 'none'; "
        f"style-src {_hash(style)}; script-src {_hash(script)}"
    )
    head = [
        element("meta", charset="utf-8"),
        element("meta", http_equiv="Content-Security-Policy", content=policy),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        *(element("meta", name=name, content=text) for name, text in (about or {}).items()),
        element("title", title),
        element("style", Html(style)),
    ]
    page = element(
        "html",
        element("head", *head),
        element("body", *body, element("script", Html(script))),
        lang="en",
    )
    return f"<!DOCTYPE html>\n{page}\n"


def theme_switch() -> Html:
    """Return the button that exchanges light and dark."""
    return element("button", "dark", type="button", class_="theme-switch", hidden=True)


def _hash(text: str) -> str:
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"
