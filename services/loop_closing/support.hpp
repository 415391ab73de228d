#pragma once

#include <vector>

#include "services/loop_closing/candidates.hpp"
#include "services/loop_closing/hypotheses.hpp"

namespace slammot::loop_closing {

/// The closure that a hypothesis proposes.
flow::Constraint closure_of(const Hypothesis& hypothesis);

/// True if both hypotheses imply the same relative pose of their two stretches, within the drift
/// between the submaps and the covariances of both matches.
bool agree(const SubmapView& submaps, const Hypothesis& a, const Hypothesis& b);

/// True if both place one submap on one island, at different poses.
bool are_rivals(const SubmapView& submaps, const Hypothesis& a, const Hypothesis& b);

/// Hypotheses of one submap, `to`, on several targets of its island compete, as those on one target
/// do: drops what is clearly worse than another that places the submap elsewhere. What remains
/// beside another nearly as good is ambiguous, and as certain as its share among them.
void select_on_one_island(const SubmapView& submaps, double rival_ratio, flow::SubmapId to,
                          std::vector<Hypothesis>& all);

/// Number of submaps with a hypothesis that agrees with this one, itself included; another one's
/// counts by its certainty: one of five poses along a corridor agrees with anything.
double support_of(const SubmapView& submaps, const std::vector<Hypothesis>& all,
                  const Hypothesis& hypothesis);

/// The hypothesis and those that agree with it and with each other (pairwise consistency;
/// Mangelson et al., ICRA 2018, by a greedy clique): at most one of each submap, best first.
std::vector<Hypothesis> consistent_set(const SubmapView& submaps,
                                       const std::vector<Hypothesis>& all,
                                       const Hypothesis& hypothesis);

/// Chi-square of a closure against the graph, given the covariances of both. Precondition: its ends
/// are on one island.
double error_with_graph_uncertainty(const ClosureGraph& graph, const flow::Constraint& closure);

}  // namespace slammot::loop_closing
