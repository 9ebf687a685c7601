# SPDX-License-Identifier: Apache-2.0
"""pages.py PROGRAM FOLDER -- manual pages, bash's completion and the page of the answers of --json,
as an installation has them.

Commands come from `PROGRAM help --json`, in section 1; guides, which it lists, from
assets/guides, in section 7. Of Markdown it knows what guides use: headings, paragraphs, lists,
tables, blocks of code, and what stands within lines. Pages are packed with no time in them.
"""
import gzip
import json
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
GUIDES = os.path.join(HERE, "..", "guides")
ANSWERS = os.path.join(HERE, "..", "schemas", "json_answers.md")
ANSWERS_MARK = "<!-- the answers of commands stand here in what the build makes of this page -->\n"
PAGE_COLUMNS = 70  # letters of a terminal's line that are left to a page's text
TABLE_TOGETHER = 16  # lines: a table near the end of a page begins the next
COLUMN_GAP = 3
STATUSES = (
    ("0", "done"),
    ("1", "done, and the answer is no: images differ, a limit is missed"),
    ("2", "the command line is wrong"),
    ("3", "an input is missing, malformed or not supported"),
    ("4", "an output cannot be written"),
    ("5", "of another instruction set or version: a part, a checkpoint, --isa"),
    ("130, 143, 129", "interrupted (INT, TERM, HUP); what was done is saved where the line on "
                      "stderr says so"))
ENVIRONMENT = (
    ("OCIO", "an OpenColorIO configuration for pictures, where --config names none"),
    ("PARHELION_STYLE", "a file of CSS that comes behind the style of every page that is "
                        "written: a firm's own look"),
    ("NO_COLOR", "if it is set, the progress has no colours"),
    ("SOURCE_DATE_EPOCH", "the time that frames are marked with"))
FILES = (
    ("share/parhelion", "beside the folder of the program: scenes/, assets/. The guides' "
                        "commands run where these two lie, or links to them"),)

# ---- words of a manual page --------------------------------------------------------------

# Letters that troff reads as its own. Behind a bar the next line may go on with a list.
ESCAPES = {"\\": "\\e", "-": "\\-", "'": "\\(aq", "`": "\\(ga", "^": "\\(ha", "~": "\\(ti",
           '"': "\\(dq", "|": "|\\:"}
MARKUP = re.compile(r"`([^`]*)`|(\*\*)|!?\[([^\]]*)\]\(([^)]*)\)")


def roff(text):
    """What is printed is what was written. A point that begins a word may come to begin a line;
    blanks behind an end of line, as rows of lists have them, would end it in the page, too."""
    return re.sub(r"(?<![A-Za-z0-9])\.|[\\\-'`^~\"|]", lambda m: ESCAPES.get(m[0], "\\&."),
                  re.sub(r"\n +", "\n", text))


def inline(text):
    """Markdown within a line or a paragraph: `code`, **strong**, [words](target)."""
    out, at, is_strong = "", 0, False
    for mark in MARKUP.finditer(text):
        out += roff(text[at:mark.start()])
        at = mark.end()
        if mark[1] is not None:
            out += f"\\fB{roff(mark[1])}\\fR"
        elif mark[2]:
            is_strong = not is_strong
            out += "\\fB" if is_strong else "\\fR"
        else:
            out += f"{roff(mark[3])} ({roff(mark[4])})"
    return out + roff(text[at:])


def title(name, section, version):
    """No hyphens are added and no blanks: what is searched for is found, what is copied works."""
    return (f"'\\\" t\n.nr HY 0\n.TH \"{roff(name.upper())}\" {section} \"\" \"Parhelion "
            f"{version}\" \"Parhelion\"\n.ad l\n.SH NAME\n{roff(name)} \\- ")


def rows(heading, list_of):
    return f".SH {heading}\n" + "".join(f".TP\n\\fB{roff(name)}\\fR\n{roff(text)}\n"
                                        for name, text in list_of)


def links(heading, list_of):
    """(name of a page, its section, what it is about), the last already as troff."""
    return f".SH {heading}\n" + "".join(f".TP\n.BR {roff(name)} ({section})\n{text}\n"
                                        for name, section, text in list_of)


# ---- commands ----------------------------------------------------------------------------


def commands_of(row, name):
    return links("COMMANDS", [(f"{name}-{own['name']}", 1, roff(own["summary"]))
                              for own in row["commands"]])


def option(row):
    value = f" \\fI{roff(row['value'])}\\fR" if row["value"] else ""
    more = "; repeatable" if row["is_repeatable"] else ""
    return f".TP\n\\fB{roff(row['name'])}\\fR{value}\n{roff(row['help'])}{more}\n"


def command_page(row, name, version):
    """name: of its page, "parhelion-panel-fit"."""
    page = (title(name, 1, version) + f"{roff(row['summary'])}\n.SH SYNOPSIS\n"
            f"\\fB{roff(name.replace('-', ' '))}\\fR "
            f"{roff(row.get('arguments', 'COMMAND ...'))}\n")
    if "commands" in row:
        page += commands_of(row, name)
    else:
        page += ".SH OPTIONS\n" + "".join(map(option, row["options"]))
        if row["rows"]:
            page += rows(roff(row["rows_title"]), [(r["name"], r["text"]) for r in row["rows"]])
        page += f".SH EXAMPLE\n{roff(row['example'])}\n"
    guide = f",\n.BR parhelion\\-{roff(row['guide'])} (7)" if row["guide"] else ""
    return page + f".SH SEE ALSO\n.BR parhelion (1){guide}\n"


def program_page(told):
    return (title("parhelion", 1, told["version"]) + f"{roff(told['summary'])}\n.SH SYNOPSIS\n"
            "\\fBparhelion\\fR COMMAND ... | \\fBhelp\\fR [NAME] | \\fB\\-h\\fR | "
            "\\fB\\-V\\fR\n" + commands_of(told, "parhelion") +
            links("GUIDES", [(f"parhelion-{guide['name']}", 7, inline(guide["title"]))
                             for guide in told["guides"]]) +
            rows("EXIT STATUS", STATUSES) + rows("ENVIRONMENT", ENVIRONMENT) +
            rows("FILES", FILES))


# ---- answers -----------------------------------------------------------------------------


def column_of(column):
    """Its row in the page: what people read, and what only who reads JSON is told."""
    words = [column.get("words", ""), column.get("about", "")]
    if "interval" in column:
        words.append(f"95 %: `{column['interval']}`")
    if column.get("none"):
        words.append(f"null: {column['none']}")
    words = "; ".join(filter(None, words)).replace("|", "\\|")
    return f"| `{column['key']}` | {column.get('unit', '')} | {words} |\n"


def answers_page(commands):
    """assets/schemas/json_answers.md, with a table for each answer where it marks the place."""
    tables = {}
    for words, row in commands:
        for answer in row.get("answers", ()):
            name = " ".join((*words, answer["with"])).strip()
            tables[name] = tables.get(name, "") + "".join(map(column_of, answer["columns"]))
    with open(ANSWERS, encoding="utf-8") as file:
        before, behind = file.read().split(ANSWERS_MARK)
    headings = {}  # commands that answer alike stand together
    for name, rows in tables.items():
        headings.setdefault(rows, []).append(f"`{name}`")
    return before + "\n".join(f"## {', '.join(names)}\n\n| key | unit | what |\n"
                              f"| --- | --- | --- |\n{rows}"
                              for rows, names in headings.items()) + behind


# ---- guides ------------------------------------------------------------------------------


def cells_of(line):
    """"| a | b |": what stands between the bars."""
    return [cell.strip(" ") for cell in re.split(r"(?<!\\)\|", line[1:-1])]


def widths_of(table):
    """Letters that each column gets, 0: as many as its cells have. Where those are too many for
    a page, what is left beside every column's longest word is shared by what each would like."""
    columns = list(zip(*table))
    wanted = [max(map(len, column)) for column in columns]
    words = [max(len(word) for cell in column for word in cell.split(" ")) for column in columns]
    every, least = (sum(all_of) + COLUMN_GAP * len(columns) for all_of in (wanted, words))
    if every <= PAGE_COLUMNS:
        return [0] * len(columns)
    room = max(PAGE_COLUMNS - least, 0)
    return [0 if want == word else word + room * (want - word) // (every - least)
            for want, word in zip(wanted, words)]


def table_of(lines):
    table = [cells_of(line) for line in lines if line.strip("|-: ")]
    widths = widths_of(table)
    sizes = [f"w({width}n)" if width else "" for width in widths]
    out = (f".PP\n.ne {TABLE_TOGETHER}\n.TS\n" + " ".join("lb" + size for size in sizes) + "\n" +
           " ".join("l" + size for size in sizes) + ".\n")
    for row in table:
        cells = ["\\&" + inline(cell) for cell in row]
        out += "\t".join(f"T{{\n.na\n{cell}\nT}}" if width and text else cell  # groff 1.23
                         for cell, width, text in zip(cells, widths, row)) + "\n"
    return out + ".TE\n"


def mark_of(line):
    """Of a list's row, "- " or "12. "."""
    mark = re.match(r"- |\d+\. ", line)
    return mark[0] if mark else ""


def is_row(line):
    return line.startswith("|") and line.endswith("|")


def begins_block(line):
    return not line or line[0] == "#" or is_row(line) or line.startswith("```") or mark_of(line)


def blocks(lines):
    """The lines of a guide block by block: headings, tables, code, rows of lists, paragraphs."""
    at = 0
    while at < len(lines):
        first, end = lines[at], at + 1
        if first.startswith("```"):
            end = lines.index("```", end) + 1
        elif is_row(first):
            while end < len(lines) and is_row(lines[end]):
                end += 1
        elif first and first[0] != "#":
            while end < len(lines) and not begins_block(lines[end].lstrip(" ")):
                end += 1
        yield lines[at:end]
        at = end


def block_text(block):
    first = block[0]
    if not first:
        return ""
    if first[0] == "#":
        return f".{'SS' if first.startswith('###') else 'SH'} {inline(first.lstrip('# '))}\n"
    if is_row(first):
        return table_of(block)
    if first.startswith("```"):
        return ".PP\n.RS 4\n.EX\n" + "".join(map(code_line, block[1:-1])) + ".EE\n.RE\n"
    mark, text = mark_of(first), inline("\n".join(block)[len(mark_of(first)):]) + "\n"
    if mark == "- ":
        return ".IP \\(bu 2\n" + text
    return (f".IP {mark.strip()} 4\n" if mark else ".PP\n") + text


def code_line(line):
    return roff(line) + "\n"


def guide_page(guide, version):
    with open(os.path.join(GUIDES, guide["name"] + ".md"), encoding="utf-8") as file:
        lines = file.read().splitlines()
    return (title(f"parhelion-{guide['name']}", 7, version) + inline(guide["title"]) +
            "\n.SH DESCRIPTION\n" + "".join(map(block_text, blocks(lines[1:]))) +
            ".SH SEE ALSO\n.BR parhelion (1)\n")


# ---- what bash completes -----------------------------------------------------------------


def means_file(value):
    """FILE, DIR, IMAGE, or a name with an ending such as X.panel."""
    return re.search(r"\.[a-z]|FILE|DIR|IMAGE", value)


def names_in(value):
    """Those of "auto|off|AZ,EL[,LUX]" that are typed as they stand."""
    return [name for name in re.findall(r"(?:^|\|)([^|[]*)", value)
            if re.fullmatch(r"[a-z0-9-]+", name)]


def completion_row(name, row):
    """A row of the shell's function: a command, or a group of commands."""
    text = f"    '{name}')\n"
    if "commands" in row:
        text += f"        commands=' {' '.join(own['name'] for own in row['commands'])}'\n"
        text += "        flags='-h -V --help --version'\n"
        if "guides" in row:
            text += f"        guides=' {' '.join(guide['name'] for guide in row['guides'])}'\n"
        return text + "        ;;\n"
    takes = {option["name"]: option["value"] for option in row["options"] if option["value"]}
    flags = ["-h", "-V"] + [o["name"] for o in row["options"] if not o["value"]]
    files = [option for option, value in takes.items() if means_file(value)]
    named = [option for option in files if "=" in takes[option]]
    files = [option for option in files if option not in named]
    text += f"        takes=' {' '.join(takes)} '\n        flags='{' '.join(flags)}'\n"
    text += f"        files=' {' '.join(files)} '\n        named=' {' '.join(named)} '\n"
    for option in takes:
        if option not in files + named and names_in(takes[option]):
            text += f"        values[{option}]=' {' '.join(names_in(takes[option]))}'\n"
    arguments = "names" if "COMMAND" in row["arguments"] else "files"
    return text + f"        arguments={arguments} ;;\n"


def completion(told, commands):
    with open(os.path.join(HERE, "completion.bash"), encoding="utf-8") as file:
        script = file.read()
    return (f"# Completion of parhelion {told['version']} in bash.\n\n_parhelion_row()\n{{\n"
            "    case $1 in\n" + "".join(completion_row(" ".join(words), row)
                                         for words, row in [((), told), *commands]) +
            "    esac\n}\n\n" + script)


# ---- all of it ---------------------------------------------------------------------------


def every_command(rows_of, before=()):
    """(words, row), those of a group behind it."""
    for row in rows_of:
        words = (*before, row["name"])
        yield words, row
        yield from every_command(row.get("commands", ()), words)


def main(program, folder):
    told = json.loads(subprocess.run([program, "help", "--json"], check=True,
                                     capture_output=True).stdout)
    commands, version = list(every_command(told["commands"])), told["version"]
    pages = {"man1/parhelion.1": program_page(told)}
    for words, row in commands:
        name = "-".join(("parhelion", *words))
        pages[f"man1/{name}.1"] = command_page(row, name, version)
    for guide in told["guides"]:
        pages[f"man7/parhelion-{guide['name']}.7"] = guide_page(guide, version)
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("man/man1", "man/man7", "completions"):
        os.makedirs(os.path.join(folder, name))
    for name, page in pages.items():
        with open(os.path.join(folder, "man", name + ".gz"), "wb") as file:
            file.write(gzip.compress(page.encode(), 9, mtime=0))
    with open(os.path.join(folder, "completions", "parhelion"), "w", encoding="utf-8") as file:
        file.write(completion(told, commands))
    with open(os.path.join(folder, "json_answers.md"), "w", encoding="utf-8") as file:
        file.write(answers_page(commands))


if __name__ == "__main__":
    main(*sys.argv[1:])
