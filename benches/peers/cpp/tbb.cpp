// The graphs of `apex-bench` as flow graphs of oneTBB, on one thread: a tick is put into the graph and waited for.
// Speaks as the program of the peers in Rust does: a line `graph peer` for each graph it has and an empty one; then for
// each line `graph peer ticks` that it reads a line `nanoseconds checksum`.

#include <chrono>
#include <cstdint>
#include <functional>
#include <iostream>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <tbb/flow_graph.h>
#include <tbb/task_arena.h>

namespace flow = tbb::flow;
using u64 = std::uint64_t;
using Token = std::optional<u64>;

// What the graphs of `apex-bench` hide from the optimiser, this does, too.
static u64 hidden(u64 x) {
    asm volatile("" : "+r"(x));
    return x;
}

static u64 op(u64 x, u64 k) { return 3 * x ^ k; }
static u64 rotl(u64 x, int by) { return x << by | x >> (64 - by); }

struct Sink {
    u64 acc = 0;
    void operator()(u64 x) { acc = hidden(rotl(acc, 5) ^ x); }
};

// Passes every `period`-th message, beginning with the first.
struct OneOf {
    u64 period, count = 0;
    bool passes() {
        bool first = count == 0;
        if (++count == period) count = 0;
        return first;
    }
};

struct Ran {
    std::chrono::nanoseconds time;
    u64 checksum;
};

// One graph at a time. Nodes without state may run as often at once as they like, which is the faster way.
struct Graphs {
    using Node = flow::function_node<u64, u64>;
    using Last = flow::function_node<u64>;
    using Maybe = flow::multifunction_node<u64, std::tuple<u64>>;

    flow::graph graph;
    std::list<Node> nodes;
    Sink sink;
    Last last{graph, flow::serial, [this](u64 x) { return sink(x), flow::continue_msg(); }};

    // Operations in a row behind `from`; the last one of them.
    template <class From>
    flow::sender<u64> &ops(From &from, u64 first, u64 end) {
        flow::sender<u64> *sender = &from;
        for (u64 k = first; k <= end; ++k) sender = &node(*sender, k);
        return *sender;
    }

    Node &node(flow::sender<u64> &from, u64 k) {
        Node &made = unconnected(k);
        flow::make_edge(from, made);
        return made;
    }

    Node &unconnected(u64 k) {
        return nodes.emplace_back(graph, flow::unlimited, [k](u64 x) { return op(x, k); });
    }

    template <class First>
    Ran lockstep(First &first, u64 ticks) {
        auto time = timed(ticks, [&](u64 t) {
            first.try_put(t);
            graph.wait_for_all();
        });
        return {time, sink.acc};
    }

    template <class Tick>
    std::chrono::nanoseconds timed(u64 ticks, Tick tick) {
        auto start = std::chrono::steady_clock::now();
        for (u64 t = 0; t < ticks; ++t) tick(hidden(t));
        return std::chrono::steady_clock::now() - start;
    }

    Ran chain(u64 n, u64 ticks) {
        Node &first = unconnected(1);
        flow::make_edge(ops(first, 2, n), last);
        return lockstep(first, ticks);
    }

    Ran diamond(u64 w, u64 ticks) {
        flow::broadcast_node<u64> source(graph);
        u64 sum = 0, count = 0;
        Maybe join(graph, flow::serial, [&](u64 x, auto &ports) {
            sum += x;
            if (++count == w) {
                std::get<0>(ports).try_put(sum);
                sum = count = 0;
            }
        });
        for (u64 k = 1; k <= w; ++k) flow::make_edge(ops(source, k, k), join);
        flow::make_edge(flow::output_port<0>(join), last);
        return lockstep(source, ticks);
    }

    Ran bot(u64 ticks) {
        Node &first = unconnected(1);
        OneOf every{100};
        Maybe filter(graph, flow::serial, [&](u64 x, auto &ports) {
            if (every.passes()) std::get<0>(ports).try_put(x);
        });
        flow::make_edge(first, filter);
        flow::make_edge(ops(flow::output_port<0>(filter), 3, 100), last);
        return lockstep(first, ticks);
    }

    // The join has to hear of every message that the filter drops.
    Ran throttle(u64 ticks) {
        Node &first = unconnected(1);
        OneOf every{10};
        flow::function_node<u64, Token> filter(
            graph, flow::serial, [&](u64 x) { return every.passes() ? Token(x) : Token(); });
        flow::function_node<Token, Token> thinned(
            graph, flow::unlimited, [](Token x) { return x ? Token(op(*x, 2)) : Token(); });
        flow::join_node<std::tuple<Token, u64>, flow::queueing> join(graph);
        flow::function_node<std::tuple<Token, u64>, flow::continue_msg> end(
            graph, flow::serial, [this](const std::tuple<Token, u64> &both) {
                if (auto [a, b] = both; a) sink(*a + b);
                return flow::continue_msg();
            });
        flow::make_edge(first, filter);
        flow::make_edge(filter, thinned);
        flow::make_edge(thinned, flow::input_port<0>(join));
        flow::make_edge(ops(first, 10, 17), flow::input_port<1>(join));
        flow::make_edge(join, end);
        return lockstep(first, ticks);
    }

    // A sends the next token when one came back, as often as there are ticks.
    Ran pingpong(u64 ticks) {
        u64 acc = 0, left = ticks;
        Node &b = unconnected(1);
        Maybe a(graph, flow::serial, [&](u64 y, auto &ports) {
            acc = hidden(rotl(acc, 5) ^ y);
            if (--left > 0) std::get<0>(ports).try_put(op(y, 2));
        });
        flow::make_edge(b, a);
        flow::make_edge(flow::output_port<0>(a), b);
        auto time = timed(1, [&](u64) {
            b.try_put(0);
            graph.wait_for_all();
        });
        return {time, acc};
    }

    Ran mpse8(u64 ticks) {
        using Value = std::pair<u64, u64>;
        u64 acc = 0;
        flow::broadcast_node<u64> source(graph);
        flow::function_node<Value, flow::continue_msg> consumer(graph, flow::serial, [&](const Value &value) {
            acc = hidden(acc + op(value.second, value.first));
            return flow::continue_msg();
        });
        std::list<flow::function_node<u64, Value>> producers;
        for (u64 p = 0; p < 8; ++p) {
            auto &producer =
                producers.emplace_back(graph, flow::unlimited, [p](u64 i) { return Value(p + 1, p << 32 | i); });
            flow::make_edge(source, producer);
            flow::make_edge(producer, consumer);
        }
        auto ran = lockstep(source, ticks);
        return {ran.time, acc};
    }
};

int main() {
    std::map<std::string, std::function<Ran(u64)>> runs;
    for (u64 n : {3, 10, 100}) runs["chain" + std::to_string(n)] = [n](u64 t) { return Graphs().chain(n, t); };
    for (u64 w : {8, 64}) runs["diamond" + std::to_string(w)] = [w](u64 t) { return Graphs().diamond(w, t); };
    runs["bot100"] = [](u64 t) { return Graphs().bot(t); };
    runs["throttle"] = [](u64 t) { return Graphs().throttle(t); };
    runs["pingpong"] = [](u64 t) { return Graphs().pingpong(t); };
    runs["mpse8"] = [](u64 t) { return Graphs().mpse8(t); };
    for (const auto &[graph, run] : runs) std::cout << graph << " tbb-1\n";
    std::cout << std::endl;

    tbb::task_arena one_thread(1);
    std::string graph, peer;
    u64 ticks;
    while (std::cin >> graph >> peer >> ticks) {
        auto found = runs.find(graph);
        if (found == runs.end()) {
            std::cerr << "cannot run `" << graph << ' ' << peer << "`\n";
            return 1;
        }
        Ran ran = one_thread.execute([&] { return found->second(ticks); });
        std::cout << ran.time.count() << ' ' << ran.checksum << std::endl;
    }
}
