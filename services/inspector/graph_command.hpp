#pragma once

namespace CLI {
class App;
}

namespace slammot::inspector {

/// Adds `slammot graph`: which process sends what to which, as text or for Graphviz.
void add_graph_command(CLI::App& app, int& exit_code);

}  // namespace slammot::inspector
