# SPDX-License-Identifier: Apache-2.0
"""kernels.py BUILD_DIR -- the hot sources are built once for each instruction set, and a vector
travels otherwise in each of those builds: what a kernel object calls in the rest of the program
may not take or return one, nor may it be called by way of a table of functions that stands
there. A source that passes vectors and was not declared hot shows here."""
import json
import os
import re
import subprocess
import sys

from report import ROOT, Report, read, sources

STRUCT = re.compile(r"typedef (?:struct|union) \w+ \{(.*?)\n\} (\w+);", re.DOTALL)
VECTOR = re.compile(r"typedef\s+[\w\s]+?\b(\w+)\s+__attribute__\(\(vector_size")
POINTER = re.compile(r"([\w ]+?\**)\s*\(\*\w+\)\s*(\([^;]*\));")  # a member
OBJECT = re.compile(r"^extern (?:const )?(\w+) ([^;(]+);", re.M)
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


def by_value(declaration, types):
    """Does a declaration of one thing hold one of the types itself, not a pointer to it?"""
    return "*" not in declaration and bool(set(re.findall(r"\w+", declaration)) & types)


def vector_types(texts):
    """Names of vectors, and of what holds one by value."""
    types = {name for text in texts for name in VECTOR.findall(text)}
    bodies = {name: body for text in texts for body, name in STRUCT.findall(text)}
    while True:
        more = {name for name, body in bodies.items() if name not in types
                and any(by_value(member, types) for member in body.split(";"))}
        if not more:
            return types
        types |= more


def passes_vector(typeref, signature, types):
    """Of a prototype: `typeref` is what it returns, `signature` its arguments in brackets. An
    array argument is a pointer."""
    arguments = re.sub(r"\w+\s*\[[^\]]*\]", "*", signature.strip()[1:-1]).split(",")
    return any(by_value(part, types) for part in [typeref, *arguments])


def tables(texts, types):
    """name -> declaration of the objects that hold functions' addresses that pass vectors."""
    risky = {name for text in texts for body, name in STRUCT.findall(text)
             if any(passes_vector(returned, signature, types)
                    for returned, signature in POINTER.findall(body))}
    return {re.sub(r"\W", "", name): f"{kind} {name.strip()}" for text in texts
            for kind, names in OBJECT.findall(text) if kind in risky
            for name in names.split(",")}


def prototypes():
    tags = subprocess.run(
        ["ctags", "--output-format=json", "--fields=+nSt", "--kinds-C=p", "-o", "-",
         *sources(".h")], cwd=ROOT, capture_output=True, check=True, text=True).stdout
    for line in tags.splitlines():
        tag = json.loads(line)
        yield tag["name"], tag.get("typeref", "").split(":")[-1], tag.get("signature", "()")


def undefined(kernel):
    listed = subprocess.run(["nm", "--undefined-only", kernel], capture_output=True, check=True,
                            text=True).stdout
    return {line.split()[-1] for line in listed.splitlines() if line.strip()}


def check_itself(report, types):
    report.claim("Spectrum" in types, "Spectrum is not known as a vector")
    report.claim("Wavelengths" in types, "a struct of vectors is not known as one")
    for typeref, signature, wanted in (
            ("Spectrum", "(int a)", True), ("void", "(float a, Spectrum b)", True),
            ("void", "(const Spectrum *a, Spectrum out[2])", False),
            ("Spectrum *", "(void)", False), ("void", "(Wavelengths w)", True)):
        report.claim(passes_vector(typeref, signature, types) == wanted,
                     f"misjudged: {typeref} f{signature}")


def main():
    build = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, ".build", "release")
    report = Report()
    texts = [COMMENT.sub("", read(name)) for name in sources(".h")]
    types = vector_types(texts)
    check_itself(report, types)
    risky = {name: f"{returned} {name}{signature}" for name, returned, signature in prototypes()
             if passes_vector(returned, signature, types)}
    report.claim(len(risky) > 10, f"only {len(risky)} functions pass vectors")
    by_address = tables(texts, types)
    report.claim("dielectric_model" in by_address, "the surface models' tables are not seen")
    risky.update(by_address)
    kernels = [name for name in sorted(os.listdir(build))
               if name.startswith("kernel_") and name.endswith(".o")]
    for name in kernels:
        wanted = undefined(os.path.join(build, name))
        report.claim(wanted, f"{name} calls nothing at all")
        report.claim_none(f"{name}: what passes vectors and is not declared hot",
                          [risky[function] for function in sorted(wanted & set(risky))])
    if not kernels:
        report.skip(f"no kernel objects in {build}: this processor or build has one set only")
    report.finish()


if __name__ == "__main__":
    main()
