/**
 * The grammar of `.afg` texts. The compiler has its own (apex-dsl/src/syntax/afg.pest); this one is for editors, and
 * tests compare the two: all texts of the repository are read without an error.
 */

/** Nothing or more of a rule, with commas between; a comma may stand at the end. */
const list = (rule) => optional(list1(rule));

/** One or more of a rule, with commas between; a comma may stand at the end. */
const list1 = (rule) => seq(rule, repeat(seq(',', rule)), optional(','));

/** In a comment, nothing else means anything. */
const inside = (precedence, text) => token.immediate(prec(precedence, text));

module.exports = grammar({
  name: 'afg',

  extras: ($) => [/\s/, $.doc_comment, $.line_comment, $.block_comment],

  word: ($) => $.identifier,

  rules: {
    source_file: ($) => repeat(choice($.use, $.graph, $.fsm, $.test, $.tune)),

    // Imports

    use: ($) => seq('use', $._use_tree, ';'),
    _use_tree: ($) => choice($.path, $.use_group, $.use_as),
    use_group: ($) => seq($.path, '::', '{', list($._use_tree), '}'),
    use_as: ($) => seq($.path, 'as', field('name', $.identifier)),

    // Graphs

    graph: ($) =>
      seq(
        optional('pub'),
        choice('graph', 'robot'),
        field('name', $.identifier),
        optional($.generics),
        optional($.parameters),
        optional(seq('=', field('base', $.path))),
        '{',
        repeat($._statement),
        '}',
      ),
    generics: ($) => seq('<', list1($.identifier), '>'),
    parameters: ($) => seq('(', list($.parameter), ')'),
    parameter: ($) =>
      seq(
        field('name', $.identifier),
        ':',
        field('type', $._type),
        optional(seq('[', field('unit', $.unit_text), ']')),
        optional(seq('=', field('default', $.expression))),
        optional($._limits),
      ),
    _limits: ($) => seq('in', $.expression, choice('..=', '..'), $.expression),
    unit_text: () => /[A-Za-z0-9\/*^%-]+/,

    _statement: ($) => choice($.port, $.node, $.claim, $.record, $.thread, $.connection),
    port: ($) =>
      seq(
        field('kind', choice('in', 'out', 'slot', 'event')),
        field('name', $.identifier),
        optional(
          seq(
            ':',
            field('type', $._type),
            optional(seq('[', field('unit', $.unit_text), ']')),
            optional(seq('in', field('frame', choice($.identifier, $.string)))),
          ),
        ),
        ';',
      ),
    node: ($) =>
      seq(
        'node',
        field('name', $.identifier),
        choice(seq('=', $.instance), seq(':', field('type', $._type), repeat($.modifier))),
        ';',
      ),
    claim: ($) => seq('claim', field('kind', $.identifier), optional(seq('(', list($.reference), ')')), ';'),
    record: ($) =>
      seq('record', field('file', $.string), optional($.arguments), '{', repeat(seq($.reference, ';')), '}'),
    thread: ($) =>
      seq(
        'thread',
        field('name', $.identifier),
        '{',
        optional(seq($.setting, repeat(seq(';', $.setting)), optional(';'))),
        '}',
      ),
    setting: ($) => seq(field('name', $.identifier), '=', field('value', $.expression)),
    connection: ($) => seq($._end, repeat1(seq($.arrow, $._end)), ';'),
    arrow: () => choice('->', '=>'),
    _end: ($) => choice($.list, $.instance, $.all_ports, $.reference, $.given),
    // The name of a port of the graph itself looks as a node in place.
    given: ($) => seq(field('of', $.identifier), '.', field('port', $.identifier), '(', $.expression, ')'),
    list: ($) => seq('[', list($._end), ']'),
    all_ports: ($) => seq(choice('in', 'out', $.identifier), '.', '*'),
    reference: ($) => seq($.identifier, repeat(seq('.', field('port', $.identifier)))),

    instance: ($) => seq(field('type', $.path), optional($.type_arguments), $.arguments, repeat($.modifier)),
    arguments: ($) => seq('(', list($.argument), ')'),
    argument: ($) => seq(optional(seq(field('name', $.identifier), '=')), field('value', $.expression)),
    modifier: ($) =>
      choice(
        seq(choice('every', 'after', 'timeout', 'deadline'), $.expression),
        seq('on', $.identifier),
        seq('each', optional('par'), optional(seq('(', field('port', $.identifier), ')'))),
        prec.right(seq('delay', optional($.expression))),
        'pipelined',
        'skip',
        'essential',
        'restart',
      ),

    // State machines

    fsm: ($) => seq('fsm', field('name', $.identifier), '{', repeat(choice($.port, $.state)), '}'),
    state: ($) =>
      seq('state', field('name', $.identifier), '{', repeat(choice($.state, $.transition, $.hook)), '}'),
    transition: ($) =>
      seq(
        choice(
          seq('on', field('slot', $.identifier), optional(seq('if', field('guard', $.expression)))),
          seq('after', field('time', $.expression)),
        ),
        optional(seq('=>', optional(choice('resume', 'repeat')), field('target', $.identifier))),
        optional($._actions),
        ';',
      ),
    hook: ($) => seq(choice('entry', 'exit'), $._actions, ';'),
    _actions: ($) => seq('->', $.action, repeat(seq(',', $.action))),
    action: ($) => seq(field('event', $.identifier), optional(seq('(', $.expression, ')'))),

    // Tests

    test: ($) =>
      seq(
        'test',
        field('name', $.identifier),
        ':',
        field('graph', $.path),
        optional($.arguments),
        '{',
        repeat(choice($.replace, $.feed, $.wait, $.expect, $.never)),
        '}',
      ),
    tune: ($) =>
      seq(
        'tune',
        field('name', $.identifier),
        ':',
        field('graph', $.path),
        optional($.arguments),
        '{',
        repeat(
          choice($.vary, $.goal, $.require, $.seeds, $.holdout, $.replace, $.feed, $.wait, $.expect, $.never),
        ),
        '}',
      ),
    vary: ($) => seq('vary', $.reference, optional($._limits), ';'),
    goal: ($) => seq(choice('minimise', 'maximise'), $.reference, optional(seq('at', $.expression)), ';'),
    require: ($) => seq('require', choice(seq('never', $.condition), seq(field('test', $.identifier), repeat(seq(',', field('test', $.identifier))))), ';'),
    seeds: ($) => seq('seeds', $.expression, ';'),
    holdout: ($) => seq('holdout', $.expression, ';'),
    replace: ($) => seq('replace', $.reference, '=', $.instance, ';'),
    feed: ($) =>
      seq(
        'feed',
        field('port', $.identifier),
        choice(
          seq('=', $.recording),
          seq(optional(seq('=', $.expression)), optional(seq('every', $.expression))),
        ),
        ';',
      ),
    recording: ($) => seq('recording', '(', $.string, ',', $.string, ')'),
    wait: ($) => seq('wait', $.expression, ';'),
    expect: ($) => seq('expect', $.condition, optional(seq(choice('by', 'within'), $.expression)), ';'),
    never: ($) => seq('never', $.condition, ';'),
    condition: ($) =>
      choice(
        seq('active', '(', $.reference, ')'),
        // A port can have that name.
        seq(choice($.reference, alias('active', $.reference)), optional(seq($._comparison, $.expression, optional(seq('+-', $.expression))))),
      ),
    _comparison: () => choice('==', '!=', '<=', '>=', '<', '>'),

    // Types

    _type: ($) => choice($.array_type, $.tuple_type, $.type),
    type: ($) => seq($.path, optional($.type_arguments)),
    type_arguments: ($) => seq('<', list1(choice($._type, $.number)), '>'),
    array_type: ($) => seq('[', $._type, optional(seq(';', $.number)), ']'),
    tuple_type: ($) => seq('(', list($._type), ')'),

    // Values

    expression: ($) => seq($._operand, repeat(seq($.operator, $._operand))),
    _operand: ($) => seq(repeat(choice('!', '-')), $._primary),
    operator: () => choice('==', '!=', '<=', '>=', '&&', '||', '<', '>', '+', '-', '*', '/', '%'),
    _primary: ($) =>
      choice($.number, $.string, $.boolean, $.values, seq('(', $.expression, ')'), $.structure, $.path),
    structure: ($) => seq(field('type', $.path), '{', list($.field), '}'),
    field: ($) => seq(field('name', $.identifier), ':', field('value', $.expression)),
    values: ($) => seq('[', list($.expression), ']'),
    boolean: () => choice('true', 'false'),
    number: ($) => seq($._digits, optional($.unit)),
    _digits: () => choice(/0x[0-9A-Fa-f_]+/, /[0-9][0-9_]*(\.[0-9][0-9_]*)?([eE][+-]?[0-9]+)?/),
    // Directly behind a number, `%` is a unit and not an operator.
    unit: () => token.immediate(prec(1, /(%|[A-Za-z]+)(\^-?[0-9]+)?([\/*][A-Za-z]+(\^-?[0-9]+)?)*/)),
    string: () => /"(\\(.|\n)|[^"\\])*"/,

    path: ($) => choice($.identifier, seq($.path, '::', $.identifier)),
    identifier: () => /[A-Za-z_][A-Za-z0-9_]*/,

    // Comments

    // Of two that are as long, the first counts.
    doc_comment: () => token(/\/\/(\/([^\/\n][^\n]*)?|![^\n]*)/),
    line_comment: () => token(/\/\/[^\n]*/),
    block_comment: ($) =>
      seq(
        '/*',
        repeat(choice(alias($._nested_comment, $.block_comment), inside(2, /[^*\/]+/), inside(2, '*'), inside(2, '/'))),
        inside(3, '*/'),
      ),
    _nested_comment: ($) =>
      seq(
        inside(3, '/*'),
        repeat(choice(alias($._nested_comment, $.block_comment), inside(2, /[^*\/]+/), inside(2, '*'), inside(2, '/'))),
        inside(3, '*/'),
      ),
  },
});
