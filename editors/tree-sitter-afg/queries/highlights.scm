; What the parts of a text are; the later of two that fit counts.

(line_comment) @comment
(block_comment) @comment
(doc_comment) @comment.documentation

(string) @string
(number) @number
(unit) @type.builtin
(unit_text) @type.builtin
(boolean) @constant.builtin

["use" "as"] @keyword.import
["pub" "graph" "robot" "fsm" "test" "tune"] @keyword.type
["in" "out" "slot" "event" "node" "claim" "record" "thread" "state"] @keyword
["on" "if" "entry" "exit" "resume" "repeat"] @keyword
["replace" "feed" "wait" "expect" "never" "by" "within" "active" "recording"] @keyword
["vary" "minimise" "maximise" "at" "require" "seeds" "holdout"] @keyword
["every" "after" "timeout" "deadline" "each" "par" "delay" "pipelined" "skip" "essential" "restart"] @keyword.modifier

(arrow) @operator
(operator) @operator
(condition "+-" @operator)
(transition ["=>" "->"] @operator)
(hook "->" @operator)
["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["," ";" ":" "::" "."] @punctuation.delimiter

(reference (identifier) @variable)
(reference port: (identifier) @property)
(given of: (identifier) @variable)
(given port: (identifier) @property)
(all_ports (identifier) @variable)
(all_ports ["in" "out"] @variable.builtin)
(all_ports "*" @property)
(path (identifier) @variable)
(type (path (identifier) @type))
(use (path (identifier) @type))
(use_group (path (identifier) @type))
(use_group (path (path (identifier) @module)))
(use_group . (path (identifier) @module))
(use_as name: (identifier) @type)
(instance type: (path (identifier) @function))
(test graph: (path (identifier) @type))
(tune graph: (path (identifier) @type))

(graph name: (identifier) @type)
(fsm name: (identifier) @type)
(test name: (identifier) @function)
(tune name: (identifier) @function)
(require test: (identifier) @function)
(state name: (identifier) @label)
(transition target: (identifier) @label)
(transition slot: (identifier) @property)
(action event: (identifier) @property)
(generics (identifier) @type)
(parameter name: (identifier) @variable.parameter)
(argument name: (identifier) @variable.parameter)
(port name: (identifier) @property)
(node name: (identifier) @variable)
(claim kind: (identifier) @function.builtin)

((reference . (identifier) @variable.builtin .)
  (#any-of? @variable.builtin "start" "hung" "set_back" "reset" "exit" "abort"))
