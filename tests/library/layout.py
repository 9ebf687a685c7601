# SPDX-License-Identifier: Apache-2.0
"""layout.py -- the structs and numbers of parhelion_panel.h as a compiler lays them out."""
import os
import re
import subprocess

STRUCT = re.compile(r"typedef struct (\w+) \{(.*?)\n\} \1;", re.DOTALL)
MEMBER = re.compile(r"^\s*(?:const )?\w+\s+\**(\w+)(?:\[\w+\])?;", re.M)
NUMBER = re.compile(r"^#define (PARHELION_PANEL_[A-Z_]+) \d"
                    r"|^    (PARHELION_PANEL_[A-Z_]+) = \d", re.M)


def program(header):
    """C that prints a line for every struct, member and number."""
    lines = ["#include <parhelion_panel.h>", "#include <stdio.h>", "int main(void) {"]
    plain = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    for name, body in STRUCT.findall(plain):
        lines.append(f'printf("struct {name} %zu\\n", sizeof({name}));')
        for member in MEMBER.findall(body):
            lines.append(f'printf("member {name}.{member} %zu %zu\\n", '
                         f"offsetof({name}, {member}), sizeof((({name} *)0)->{member}));")
    for match in NUMBER.finditer(plain):
        name = match[1] or match[2]
        lines.append(f'printf("number {name} %d\\n", (int){name});')
    return "\n".join([*lines, "return 0; }", ""])


def lines_of(header, include, folder, compiler="cc"):
    source, binary = (os.path.join(folder, name) for name in ("layout.c", "layout"))
    with open(header, encoding="utf-8") as file:
        text = program(file.read())
    with open(source, "w", encoding="utf-8") as file:
        file.write(text)
    subprocess.run([compiler, "-std=c99", "-I", include, "-o", binary, source], check=True)
    return subprocess.run([binary], capture_output=True, text=True, check=True).stdout


def symbols_of(library):
    """What a program can link to: "symbol NAME VERSION" lines."""
    listed = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True,
                            text=True, check=True).stdout
    names = sorted(line.split()[-1] for line in listed.splitlines() if line.split()[-2] != "A")
    return "".join(f"symbol {name.replace('@@', ' ')}\n" for name in names)
