"""Mutants of C++ code: small faults that a test should notice.

A mutant replaces a few characters of one line. Comments, literals, preprocessor lines and assertions are left alone. The sites are found
in the text, without a compiler: operators are told from templates, pointers and references by the blanks around them.
"""

import dataclasses
import hashlib
import random
import re

# What is only said, checked for precondition or allocated ahead: no test can notice it.
UNSEEN = re.compile(r"\bassert\(|static_assert|\.reserve\(| = default;|^\s*(#|using |namespace |template|typedef |friend )|\[\[")

NOT_A_STATEMENT = re.compile(r"^\s*(return|using|const|constexpr|auto|static|throw|delete|public|private|protected|case|default|break|goto|namespace)\b")
STATEMENT = re.compile(r"^(\s*)((?:\+\+|--)[\w.\[\]]+|[A-Za-z_][\w.:>\[\]()*-]*(?:\(.*\)| [-+*/|&]?= .*|\+\+|--)|continue);$")
INDEXES_A_MATRIX = re.compile(r"\.(block|head|tail|segment|row|col|topRows|leftCols)\b|\b[A-Z]\(")  # beyond its end is no fault that a test sees
NUMBER = re.compile(r"(?<![\w.])(\d[\d']*\.\d[\d']*(?:e[-+]?\d+)?|\d[\d']*(?:e[-+]?\d+)?)([UuLlFf]*)(?![\w.])")
ENDS_A_TERM = {" + ", " - ", " < ", " > ", " <= ", " >= ", " == ", " != ", " && ", " || ", " ? ", " : ", " = ", " << "}
ENDS_A_FACTOR = ENDS_A_TERM | {" * ", " / "}
ENDS_A_CONDITION = {" && ", " || ", " ? ", " : ", " = ", " << "}


@dataclasses.dataclass(frozen=True)
class Mutant:
    path: str
    line: int  # from 1
    column: int  # from 0
    operator: str
    before: str
    after: str
    whole_line: str

    @property
    def id(self):
        """Names the mutant while its line and its place are as they are."""
        code = hashlib.sha256(f"{self.whole_line}\0{self.before}\0{self.after}".encode()).hexdigest()[:8]
        return f"{self.path}:{self.line}:{self.column}:{self.operator}:{code}"

    def applied(self, text):
        lines = text.split("\n")
        line = lines[self.line - 1]
        if line != self.whole_line:
            raise ValueError(f"{self.path}:{self.line} is not the line that the mutant was made of")
        lines[self.line - 1] = self.mutated_line()
        return "\n".join(lines)

    def mutated_line(self):
        return self.whole_line[:self.column] + self.after + self.whole_line[self.column + len(self.before):]


def blanked(text):
    """The text with comments and the insides of literals replaced by blanks: every other character stays where it is."""
    token = re.compile(r"//[^\n]*|/\*.*?\*/|R\"\((?:.*?)\)\"|\"(?:\\.|[^\"\\\n])*\"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'", re.DOTALL)

    def blank(match):
        kept = re.sub(r"[^\n]", " ", match.group())
        return kept if match.group().startswith("/") else '"' + kept[1:-1] + '"'

    return token.sub(blank, text)


def end_of_operand(line, begin, ends):
    """Where the operand that begins at `begin` ends: before an operator of `ends`, a comma, a semicolon or the bracket around it."""
    depth = 0
    for i in range(begin, len(line)):
        if line[i] in "([{":
            depth += 1
        elif line[i] in ")]}":
            if depth == 0:
                return i
            depth -= 1
        elif depth == 0 and (line[i] in ",;" or any(line.startswith(end, i) for end in ends)):
            return i
    return None  # goes on in the next line


def swaps(line, pairs):
    for match in re.finditer(r"(?<=[\w)\]}]) (\+|-|\+=|-=|<|>|<=|>=) (?=\S)", line):
        if match.group(1) in pairs:
            yield match.start(1), match.group(1), pairs[match.group(1)]


def flipped_signs(line):
    yield from swaps(line, {"+": "-", "-": "+", "+=": "-=", "-=": "+="})
    for match in re.finditer(r"(?<=[(,=?:{] )-(?=[\w(])|(?<=[({])-(?=[\w(])|(?<=return )-(?=[\w(])", line):
        yield match.start(), "-", "+"


def swapped_comparisons(line):
    yield from swaps(line, {"<": ">", ">": "<", "<=": ">=", ">=": "<="})


def altered_constants(line):
    for match in NUMBER.finditer(line):
        value = float(match.group(1).replace("'", ""))
        is_whole = not re.search(r"[.e]", match.group(1))
        in_brackets = line[match.start() - 1:match.start()] in "<[" and line[match.end():match.end() + 1] in ">]" if match.start() else False
        in_template = re.search(r"<[\w:, ]*$", line[:match.start()]) and re.match(r"[\w:, ]*>", line[match.end():])
        if value == 0.0 or (is_whole and (value < 2 or in_brackets or in_template or INDEXES_A_MATRIX.search(line))):
            continue
        yield match.start(), match.group(), f"(2 * {match.group()})"


def dropped_terms(line):
    for operator, ends in ((" + ", ENDS_A_TERM), (" - ", ENDS_A_TERM), (" * ", ENDS_A_FACTOR), (" && ", ENDS_A_CONDITION), (" || ", ENDS_A_CONDITION)):
        for match in re.finditer(r"(?<=[\w)\]}])" + re.escape(operator) + r"(?=\S)", line):
            end = end_of_operand(line, match.end(), ends)
            if end is not None:
                yield match.start(), line[match.start():end], ""


def negated_conditions(line):
    for match in re.finditer(r"\b(?:if|while) \(", line):
        end = end_of_operand(line, match.end(), ())
        while end is not None and line[end] != ")":  # the semicolon after a declaration, or a comma
            begin, end = end + 1, end_of_operand(line, end + 1, ())
            if end is not None and line[begin - 1] == ";":
                match_end = begin + (line[begin] == " ")
                condition = line[match_end:end]
                if line[end] == ")" and condition:
                    yield match_end, condition, f"!({condition})"
                    break
        else:
            if end is None:
                continue
            condition = line[match.end():end]
            if not re.search(r"(?<![=!<>])=(?!=)", condition):
                yield match.end(), condition, f"!({condition})"


def removed_statements(line):
    match = STATEMENT.match(line.rstrip())
    if match and not NOT_A_STATEMENT.match(line) and line.count("(") == line.count(")"):
        yield len(match.group(1)), line.rstrip()[len(match.group(1)):], ";"


OPERATORS = {
    "sign": flipped_signs,
    "constant": altered_constants,
    "term": dropped_terms,
    "comparison": swapped_comparisons,
    "condition": negated_conditions,
    "statement": removed_statements,
}


def mutants_of(path, text):
    """Every mutant of a file, in the order of the file."""
    found = []
    lines = text.split("\n")
    for number, (line, code) in enumerate(zip(lines, blanked(text).split("\n")), start=1):
        if UNSEEN.search(code):
            continue
        for name, operator in OPERATORS.items():
            for column, before, after in operator(code):
                original = line[column:column + len(before)]
                if name == "condition":
                    after = f"!({original})"
                found.append(Mutant(path, number, column, name, original, after, line))
    return found


def drawn(files, seed):
    """All mutants of {path: text} in an order drawn by the seed: files take turns, and in a file the operators.

    The first n are the same however many are asked for.
    """
    chance = random.Random(seed)
    piles = []
    for path in sorted(files):
        by_operator = {}
        for mutant in mutants_of(path, files[path]):
            by_operator.setdefault(mutant.operator, []).append(mutant)
        for pile in by_operator.values():
            chance.shuffle(pile)
        operators = sorted(by_operator)
        chance.shuffle(operators)
        piles.append(list(in_turns([by_operator[name] for name in operators])))
    chance.shuffle(piles)
    return list(in_turns(piles))


def in_turns(piles):
    for turn in range(max(map(len, piles), default=0)):
        for pile in piles:
            if turn < len(pile):
                yield pile[turn]
