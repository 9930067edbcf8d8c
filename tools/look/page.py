"""Pieces of the pages of `report`: cards, tables, figures."""

import html
import io
import pathlib
import re

HERE = pathlib.Path(__file__).resolve().parent


def table(heads, rows, words=(), last=None):
    """HTML of a table; columns `words` hold text, the row whose first cell is `last` is a sum."""
    kind = lambda i: ' class="words"' if i in words else ""  # noqa: E731
    head = "".join(f"<th{kind(i)}>{html.escape(text)}</th>" for i, text in enumerate(heads))
    body = "".join(
        f"<tr{' class=sum' if last and row[0] == last else ''}>" + "".join(f"<td{kind(i)}>{html.escape(str(cell))}</td>" for i, cell in enumerate(row)) + "</tr>"
        for row in rows
    )
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def card(title, content, kind="", name=""):
    return f'<section class="card {kind}"{f" id={name}" if name else ""}><h2>{html.escape(title)}</h2>{content}</section>'


def inline_svg(panel, number):
    """The figure of a panel as part of a page; its ids are made to differ from those of others."""
    import figures

    text = io.StringIO()
    figures.save(figures.figure_of([panel]), text, format="svg", style={"svg.fonttype": "none"})
    svg = re.sub(r"^.*?(?=<svg)", "", text.getvalue(), flags=re.DOTALL)
    svg = re.sub(r'\bid="([^"]+)"', rf'id="f{number}-\1"', svg)
    svg = re.sub(r"url\(#([^)]+)\)", rf"url(#f{number}-\1)", svg)
    return re.sub(r'xlink:href="#([^"]+)"', rf'xlink:href="#f{number}-\1"', svg)


def prose(text):
    """HTML of a sentence, with what stands in backticks as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(text))


def head_card(title, status, kind, sentence, facts):
    """The first card: what it is, how it ended, what it holds."""
    cells = "".join(f'<div class="fact"><b>{html.escape(value)}</b><span>{html.escape(what)}</span></div>' for value, what in facts)
    return (
        f'<section class="card"><h1>{html.escape(title)}</h1><div class="lead"><span class="badge {kind}">{html.escape(status)}</span>'
        f'<span>{prose(sentence)}</span></div><div class="facts">{cells}</div></section>'
    )


def list_of(texts):
    return "<ul>" + "".join(f"<li>{prose(text)}</li>" for text in texts) + "</ul>"


def document(title, content, scripts=""):
    """A whole page with its style."""
    style = (HERE / "report.css").read_text(encoding="utf-8")
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{html.escape(title)}</title><style>{style}</style></head><body><main>{content}</main>{scripts}</body></html>\n"
    )
