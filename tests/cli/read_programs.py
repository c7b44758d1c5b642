#!/usr/bin/env python3
"""Reads robot programs by parsers of other people, and compares their places and times with a trajectory's.

read_programs.py GRAMMARS TRAJECTORY.json PROGRAM...

GRAMMARS is a folder that this project does not hold:
  krl.g4                     antlr/grammars-v4, kuka (rules whose names are Python's, such as type, end in _)
  Rapid.g4                   racarla96/rapid_parser
  urscript_app/validator_new SonnyMax/URScript_AI_Generator: its lexer, parser, ast_nodes and result
G-code is read by rs274, LinuxCNC's interpreter, which RS274 names where it is not on the path.
Prints a line for each program; exits with 1 at the first difference or complaint of a parser. Needs antlr4 and
python3-antlr4.
"""
import importlib
import json
import math
import os
import re
import subprocess
import sys
import tempfile

# Digits that the programs have: 1 um or 0.1 um; a rotation vector to 1e-6 rad, degrees and quaternions to 1e-4 and 1e-8.
POSITION, ROTATION = 1.1e-6, 3e-6


def multiply(a, b):
    return (a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0])


def rotate(q, v):
    return multiply(multiply(q, (0, *v)), (q[0], -q[1], -q[2], -q[3]))[1:]


def about(axis, angle):
    return (math.cos(angle / 2), *(math.sin(angle / 2) * x for x in axis))


def expected(trajectory):
    """The tool's place (position, rotation) in the robot's frame and the seconds on the way there, point by point."""
    base, rows = trajectory['base'], []
    for number, move in enumerate(trajectory['moves']):
        for i, p in enumerate(move['points']):
            place = [a + b for a, b in zip(base['position'], rotate(base['rotation'], p[1:4]))]
            turn = multiply(multiply(base['rotation'], p[4:8]), (0, 1, 0, 0))
            if i > 0:
                rows.append((place, turn, p[0] - move['points'][i - 1][0]))
            elif number == 0:
                rows.append((place, turn, None))  # where the program begins
    return rows


def antlr(folder, grammar, name, start):
    """Returns a function that parses a text from rule `start` on by ANTLR's parser of a grammar."""
    subprocess.run(['antlr4', '-Dlanguage=Python3', '-no-listener', '-o', folder, '-Xexact-output-dir', grammar], check=True)
    import antlr4
    from antlr4.error.ErrorListener import ErrorListener

    class Complain(ErrorListener):
        def syntaxError(self, recognizer, symbol, line, column, message, error):
            raise SystemExit(f'line {line}:{column} {message}')

    lexer_class = getattr(importlib.import_module(name + 'Lexer'), name + 'Lexer')
    parser_class = getattr(importlib.import_module(name + 'Parser'), name + 'Parser')

    def parse(text):
        lexer = lexer_class(antlr4.InputStream(text))
        parser = parser_class(antlr4.CommonTokenStream(lexer))
        for part in (lexer, parser):
            part.removeErrorListeners()
            part.addErrorListener(Complain())
        return getattr(parser, start)(), parser
    return parse


def children(node, *rules):
    """The children of a node of the tree that are of these rules."""
    return [c for c in node.getChildren() if type(c).__name__.removesuffix('Context') in rules]


def descend(node, rule):
    """All nodes of a rule below a node, in the order of the text, none inside another."""
    if type(node).__name__ == rule + 'Context':
        yield node
    elif node.getChildCount():
        for child in node.getChildren():
            yield from descend(child, rule)


def rapid_value(node):
    aggregates = list(descend(node, 'Aggregate'))
    if not aggregates:
        text = node.getText()
        return {'TRUE': True, 'FALSE': False}[text] if text in ('TRUE', 'FALSE') else float(text)
    return [rapid_value(e) for e in aggregates[0].expression()]


class Rows:
    """What a program does: places (position, rotation) with the seconds on the way there, and waits (no place)."""

    def __init__(self):
        self.list, self.tool, self.at = [], None, None

    def start(self, place, turn):
        self.list.append((place, turn, None, 0))
        self.at = place, turn

    def go(self, place, turn, time=None, speed=None, turning=None):
        """By a time, or by speeds of path and turn; `slack` is what the digits of place and speed change in seconds."""
        slack = 1e-6
        if time is None:
            length = math.dist(self.at[0], place)
            time = length / speed
            slack += 2 * POSITION / speed + 1e-6 * time / speed
            if turning:
                time = max(time, turn_between(self.at[1], turn) / turning)
                slack += 2 * ROTATION / turning + 1e-4 * time
        self.list.append((place, turn, time, slack))
        self.at = place, turn

    def wait(self, time):
        self.list.append((None, None, time, 1e-6))


def read_rapid(parse, text):
    tree, _ = parse(text)
    rows = Rows()
    for data in descend(tree, 'DataDeclaration'):
        if data.dataType().getText() == 'tooldata':
            place, turn = rapid_value(data.expression())[1]
            rows.tool = [1e-3 * x for x in place], turn
    for statement in descend(tree, 'Statement'):
        if move := statement.moveJStatement() or statement.moveLStatement():
            place, turn = rapid_value(move.namedOrPositionalExpr(0))[:2]
            place = [1e-3 * x for x in place]
            assert move.namedOrPositionalExpr(3).getText() == 'tBrush'
            if statement.moveJStatement():
                rows.start(place, turn)
            else:
                rows.go(place, turn, time=float(move.switchExpr(0).expression().getText()))
        elif (call := statement.procedureCallStatement()) and call.IDENTIFIER().getText() == 'WaitTime':
            rows.wait(float(call.argumentList().argument()[-1].getText()))
    return rows


def read_krl(parse, text):
    tree, _ = parse(text)
    rows, values = Rows(), {}

    def frame(node):
        v = {e.variableName().getText(): float(e.unaryPlusMinuxExpression().getText()) for e in descend(node, 'StructElement')}
        a, b, c = (about(axis, math.radians(v[k])) for k, axis in (('A', (0, 0, 1)), ('B', (0, 1, 0)), ('C', (1, 0, 0))))
        return [1e-3 * v[k] for k in 'XYZ'], multiply(multiply(a, b), c)

    for statement in descend(tree, 'Statement'):
        first = statement.getChild(0).getText()
        if first == 'PTP':
            rows.start(*frame(statement))
        elif first == 'LIN':
            rows.go(*frame(statement), speed=values['$VEL.CP'], turning=math.radians(values['$VEL.ORI1']))
        elif first == 'WAIT':
            rows.wait(float(statement.expression(0).getText()))
        elif assignment := statement.assignmentExpression():
            name, *value = assignment.expression()
            if name.getText() == '$TOOL':
                rows.tool = frame(value[0])
            elif name.getText().startswith('$VEL.'):
                values[name.getText()] = float(value[0].getText())
    return rows


def read_urscript(parse_source, text):
    program, complaints = parse_source(text)
    if complaints:
        raise SystemExit(f'line {complaints[0].line}: {complaints[0].message}')
    function, call = program.body
    assert call.name == function.name and not call.args
    rows = Rows()

    def frame(pose):
        v = [e.value for e in pose.elements]
        angle = math.hypot(*v[3:])
        return v[:3], about([x / angle for x in v[3:]] if angle > 0 else (1, 0, 0), angle)

    for step in function.body:
        named = {name: e.value for name, e in step.kwargs}
        if step.name == 'set_tcp':
            rows.tool = frame(step.args[0])
        elif step.name == 'sleep':
            rows.wait(step.args[0].value)
        elif step.name == 'movej':
            rows.start(*frame(step.args[0]))
        else:
            assert step.name in ('movel', 'movep'), step.name
            assert named['v'] > 0 and named['a'] > 0
            rows.go(*frame(step.args[0]), time=named.get('t'), speed=named['v'])
    return rows


def read_gcode(path, folder):
    """As LinuxCNC performs it: places only, no turns."""
    for name in ('tools.tbl', 'parameters.var'):
        open(os.path.join(folder, name), 'w', encoding='utf-8').close()
    ran = subprocess.run([os.environ.get('RS274', 'rs274'), '-t', os.path.join(folder, 'tools.tbl'), '-v',
                          os.path.join(folder, 'parameters.var'), '-g', path], capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        raise SystemExit(f'{path}: {ran.stderr.strip()}')
    rows, speed = Rows(), None
    for name, values in re.findall(r'([A-Z_]+)\(([-0-9., ]*)\)', ran.stdout):
        if name == 'SET_FEED_RATE':
            speed = float(values) / 60000
        elif name == 'DWELL':
            rows.wait(float(values))
        elif name.startswith('STRAIGHT_'):
            place = [1e-3 * float(v) for v in values.split(',')[:3]]
            if name == 'STRAIGHT_TRAVERSE':
                rows.start(place, None)
            else:
                rows.go(place, None, speed=max(speed, 1e-9))
    return rows


def turn_between(p, q):
    return 0 if p is None else 4 * math.asin(min(1, min(math.dist(p, q), math.dist(p, [-x for x in q])) / 2))


def compare(path, rows, truth):
    """Goes through both: a way may end by a wait that belongs to it, and a point that stays may be a wait."""
    worst = [0.0, 0.0, 0.0]
    i, at = 0, truth[0]
    for place, turn, seconds in truth:
        if i == len(rows.list):
            raise SystemExit(f'{path}: ends before {place}')
        to, rotation, time, slack = rows.list[i]
        i += 1
        if to is None:
            to, rotation = at[:2]
        elif seconds is not None and time + slack < seconds and i < len(rows.list) and rows.list[i][0] is None:
            time += rows.list[i][2]
            i += 1
        at = to, rotation
        worst[0] = max(worst[0], math.dist(to, place))
        worst[1] = max(worst[1], turn_between(rotation, turn))
        if seconds is not None:
            worst[2] = max(worst[2], abs(time - seconds))
            if abs(time - seconds) > slack:
                raise SystemExit(f'{path}: motion {i} takes {time} s, not {seconds} s')
    if i != len(rows.list):
        raise SystemExit(f'{path}: goes on after the last point')
    return worst


def main(grammars, trajectory, *programs):
    with open(trajectory, encoding='utf-8') as file:
        trajectory = json.load(file)
    truth = expected(trajectory)
    with tempfile.TemporaryDirectory() as folder:
        sys.path[:0] = [folder, grammars]
        sys.setrecursionlimit(20000)
        for path in programs:
            with open(path, encoding='utf-8') as file:
                text = file.read()
            extension = os.path.splitext(path)[1]
            if extension == '.mod':
                rows = read_rapid(antlr(folder, os.path.join(grammars, 'Rapid.g4'), 'Rapid', 'rapidModule'), text)
            elif extension == '.src':
                rows = read_krl(antlr(folder, os.path.join(grammars, 'krl.g4'), 'krl', 'module'), text)
            elif extension == '.gcode':
                rows = read_gcode(path, folder)
            else:
                rows = read_urscript(importlib.import_module('urscript_app.validator_new.parser').parse_source, text)
            worst = compare(path, rows, truth)
            if rows.tool:
                worst[0] = max(worst[0], math.dist(rows.tool[0], trajectory['tool']['position']))
                worst[1] = max(worst[1], turn_between(rows.tool[1], trajectory['tool']['rotation']))
            print(f'{path}: {len(rows.list)} motions; at most {worst[0]:.1e} m, {worst[1]:.1e} rad, {worst[2]:.1e} s off')
            if worst[0] > POSITION or worst[1] > ROTATION:
                raise SystemExit(1)


if __name__ == '__main__':
    main(*sys.argv[1:])
