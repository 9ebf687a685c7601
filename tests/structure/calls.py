# SPDX-License-Identifier: Apache-2.0
"""calls.py -- what no source may call: no shell and no other program, no network, no code that
is loaded while the program runs, no file that is mapped (one that shrinks would kill us), and no
stream but by src/print/print.c, which escapes what a foreign name could make a terminal do. No
file is made but by src/base/file_write.c.
"""
import re
import sys

from report import Report, read, sources

FORBIDDEN = {
    "a shell or another program": "system popen execl execlp execle execv execvp execvpe "
                                  "execve fexecve fork vfork posix_spawn posix_spawnp",
    "the network": "socket socketpair connect bind listen accept accept4 send sendto sendmsg "
                   "recv recvfrom recvmsg getaddrinfo gethostbyname getnameinfo",
    "code that is loaded later": "dlopen dlmopen",
    "a name that another process can guess": "tmpnam tempnam mktemp tmpfile",
    "a mapped file": "mmap mmap64 mremap",
    "a number that base/number.h does not read": "strtod strtof strtold strtol strtoul strtoll "
                 "strtoull atof atoi atol atoll sscanf stod stof stoi stol",
    "a stream": "printf fprintf vprintf vfprintf dprintf puts fputs putchar putc fputc fwrite "
                "perror",
}
# What a file may call all the same, with a word that must stand in the same call: memory that
# is no file, and the program's own part of that name and no other.
ALLOWED = {("src/base/arena.c", "mmap"): "MAP_ANONYMOUS",
           ("third_party/openimageio/image_file.c", "dlopen"): "path, RTLD_NOW",
           ("src/panel/set/set_writer.c", "fwrite"): "text->data",
           # below base; what is read is written again and compared; the reader itself
           ("src/print/print.c", "strtol"): "at, &end", ("src/film/film_part.c", "sscanf"): "",
           **{("src/base/number.c", name): "text" for name in ("strtod", "strtof", "strtoull")}}
STREAM = "a stream"
# Behind print.h; the other prints the program's own tables alone, in another language's letters.
PRINTERS = ("src/print/print.c", "shaders/tables/make_tables.c")
# Where a file may be made under a name: file_write.c follows no link there, and writes over
# nothing. The other makes the program's own tables, where the build names the file.
MAKES = re.compile(r"\bO_CREAT\b|\bcreat(?:64)?\s*\(|\bmkstemp|\bofstream\b|"
                   r"\bf(?:d|re)?open\s*\([^;]*\"[wa][^\"]*\"")
MAKERS = {"src/base/file_write.c": 1, "shaders/tables/make_tables.c": 1}
HEADERS = re.compile(r'#\s*include\s*[<"](sys/socket|netdb|netinet/|arpa/|spawn|curl)')
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"", re.DOTALL)


def code_of(text):
    """Without comments and strings, line by line as it was."""
    return COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def calls_in(name, text):
    """(line, function, what it stands for) of every forbidden call. A function of our own of
    the same name is told by its declaration: a type stands before it."""
    code = code_of(text)
    for what, names in FORBIDDEN.items():
        if what == STREAM and name in PRINTERS:
            continue
        any_name = "|".join(names.split())
        for match in re.finditer(rf"(?<![\w.>])(?:::\s*)?\b({any_name})\s*\(", code):
            before = code[:match.start()].rstrip()
            is_own = re.search(rf"\b(?:bool|int|void|static\s+\w+)\s+{match[1]}\s*\(", code)
            word = ALLOWED.get((name, match[1]))
            end = code.find(";", match.end())
            call = text[match.end():end]
            if is_own or before.endswith((".", "->")) or word is not None and word in call:
                continue
            yield code.count("\n", 0, match.start()) + 1, match[1], what


def made_in(text):
    """How often a file is made; strings stay, comments go."""
    return len(MAKES.findall(re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)))


def check_itself(report):
    for text, count in (("open(path, O_RDWR | O_CREAT, 0666);", 1), ("/* O_CREAT */", 0),
                        ('fopen(name, "wb");', 1), ('fopen(name, "rbe");', 0),
                        ("std::ofstream out(name);", 1), ("creat(path, 0666);", 1),
                        ('fdopen(handle, "a");', 1), ("fopen(name, mode);", 0)):
        report.claim(made_in(text) == count, f"calls.py: {text!r} makes {made_in(text)} files")
    for text, count in (('x = system("ls");', 1), ("/* system() */", 0), ("door->open(x);", 0),
                        ("std::system(x);", 1), ("static bool connect(int a);\nconnect(1);", 0),
                        ("mmap(NULL, 1, 2, MAP_ANONYMOUS, -1, 0);", 1), ("filesystem(x);", 0),
                        ('printf("%s", name);', 1), ('snprintf(to, 9, "%s", name);', 0),
                        ("std::fputs(name, stderr);", 1), ("send(1, x, 2, 0);", 1)):
        found = list(calls_in("x.c", text))
        report.claim(len(found) == count, f"calls.py: {text!r} has {found}")


def main():
    report, names = Report(), sources(".c", ".h", ".cpp", ".hpp")
    found = [(kind, f"{name}:{line}: {function}") for name in names
             for line, function, kind in calls_in(name, read(name))]
    for what in FORBIDDEN:
        report.claim_none(f"calls of {what}", [call for kind, call in found if kind == what])
    report.claim_none("headers of other programs and the network", [
        f"{name}: {match[0]}" for name in names
        for match in HEADERS.finditer(read(name))])
    report.claim_none("files made elsewhere than by base/file_write.h", [
        f"{name}: {count}" for name in names
        if (count := made_in(read(name))) > MAKERS.get(name, 0)])
    report.claim(len(names) > 100, f"{len(names)} sources only")
    check_itself(report)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
