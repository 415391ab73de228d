#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/association/assignment.hpp"
#include "common/association/ranked_assignments.hpp"

namespace slammot::association {

struct MhtConfig {
  std::size_t most_hypotheses = 6;      ///< That a cluster keeps.
  std::size_t most_children = 3;        ///< Best assignments of each hypothesis that are tried in a scan.
  std::size_t scans_back = 10;          ///< Decisions older than this are final.
  std::size_t most_tracks = 8;          ///< Larger clusters are decided at once, by the best assignment.
  double most_cost_above_best = 12.0;   ///< Costlier hypotheses are dropped: at most e^-6 times as probable as the best.
};

/// Names a track for as long as it lives.
using TrackKey = std::uint32_t;

/// What multiple hypotheses must know of tracks and of one scan's measurements. Costs are -2 times a logarithm of a
/// likelihood ratio against a false measurement, kinematic and geometric parts together: Wang 2004, Eqs. (5.1)-(5.11).
template <class Model, class State>
concept ScanOfTracks = requires(const Model model, TrackKey key, const State& state, std::size_t measurement, std::size_t sharers) {
  { model.measurement_count() } -> std::convertible_to<std::size_t>;
  /// How many tracks may share the measurement, at least 1: several objects may be seen as one.
  { model.capacity(measurement) } -> std::convertible_to<std::size_t>;
  /// kForbidden outside the gate. sharers: so many other tracks have the measurement already.
  { model.pair_cost(key, state, measurement, sharers) } -> std::convertible_to<double>;
  /// Of having none: more where the scan should have seen it, less where something hides it.
  { model.miss_cost(key, state) } -> std::convertible_to<double>;
  /// sharers: so many other tracks have the measurement in this hypothesis.
  { model.updated(key, state, measurement, sharers) } -> std::convertible_to<State>;
  { model.missed(key, state) } -> std::convertible_to<State>;
  /// Whether it makes no difference any more by which of two pasts the state came about.
  { model.are_same(state, state) } -> std::convertible_to<bool>;
};

/// Multiple hypothesis tracking (Wang 2004, Section 5.2; Reid 1979; Cox and Hingorani 1996) of tracks that exist: what is
/// ambiguous is decided when later scans have shown who is who. Tracks that no shared measurement connects are clusters of
/// their own (Figure 5.3); each cluster keeps its best joint hypotheses, grown by the best assignments (Murty 1968), without
/// those that are too improbable, those that have come to the same, and those that differ in what was decided too long ago.
/// Tracks begin and end outside. Bounded: most_hypotheses states for each track, whatever is measured.
template <class State>
class MultipleHypotheses {
 public:
  explicit MultipleHypotheses(const MhtConfig& config) : config_(config) {}

  bool has(TrackKey key) const { return cluster_of(key) != kUnassigned; }
  std::vector<TrackKey> keys() const;

  /// A track that is new here and surely in this state.
  void add(TrackKey key, const State& state);

  /// Forgets a track; what remains of its cluster keeps its hypotheses.
  void remove(TrackKey key);

  /// State in the best hypothesis of the track's cluster.
  const State& best(TrackKey key) const;
  void set_best(TrackKey key, const State& state);

  /// Changes all states that are not in a best hypothesis, such as to predict them: change(key, state).
  template <class Change>
  void change_alternatives(const Change& change);

  /// Goes on by one scan; all states are predicted to it.
  template <ScanOfTracks<State> Model>
  void step(const Model& model);

  /// Measurement in the best hypothesis after the last step; kUnassigned if none.
  std::size_t measurement_of(TrackKey key) const;

  /// Whether the last step made another past the best one.
  bool is_revised(TrackKey key) const { return clusters_[cluster_of(key)].is_revised; }

  /// Hypotheses of the track's cluster, 1 where nothing is ambiguous.
  std::size_t hypothesis_count(TrackKey key) const { return clusters_[cluster_of(key)].hypotheses.size(); }

 private:
  struct Joint {
    double cost = 0.0;                                ///< Above the best of the cluster.
    std::vector<State> states;                        ///< In the order of the cluster's keys.
    std::vector<std::size_t> measurements;
    std::vector<std::uint32_t> lineage;               ///< Names of its ancestors of the last scans, oldest first.
  };
  struct Cluster {
    std::vector<TrackKey> keys;
    std::vector<Joint> hypotheses;                    ///< Best first.
    bool is_revised = false;
    std::vector<char> gated;                          ///< Measurements that any of its tracks may have, in this scan.
  };
  struct Child {
    double cost = 0.0;
    std::size_t parent = 0;
    std::vector<std::size_t> column_of_row;
  };

  std::size_t cluster_of(TrackKey key) const;
  static std::size_t place_in(const Cluster& cluster, TrackKey key);
  template <class Model>
  void find_gated(const Model& model, Cluster& cluster) const;
  template <class Model>
  void join_clusters(const Model& model);
  void join(Cluster& into, const Cluster& other) const;
  template <class Model>
  void advance(const Model& model, Cluster& cluster);
  template <class Model>
  void find_children(const Model& model, const Cluster& cluster);
  template <class Model>
  Joint grown(const Model& model, const Cluster& cluster, const Child& child);
  template <class Model>
  void merge_same(const Model& model, std::vector<Joint>& hypotheses) const;
  void prune_by_age(std::vector<Joint>& hypotheses) const;
  template <class Model>
  void split_decided(const Model& model);

  MhtConfig config_;
  std::vector<Cluster> clusters_;
  std::uint32_t next_name_ = 1;
  AssignmentRanking ranking_;
  CostMatrix costs_;
  std::vector<std::size_t> columns_;                  ///< Measurement of each column; shared ones have several.
  std::vector<std::size_t> occurrence_;               ///< The how-manieth column of its measurement each is.
  std::vector<Child> children_;
};

template <class State>
std::size_t MultipleHypotheses<State>::place_in(const Cluster& cluster, TrackKey key) {
  return static_cast<std::size_t>(std::find(cluster.keys.begin(), cluster.keys.end(), key) - cluster.keys.begin());
}

template <class State>
std::size_t MultipleHypotheses<State>::cluster_of(TrackKey key) const {
  for (std::size_t i = 0; i < clusters_.size(); ++i)
    if (place_in(clusters_[i], key) < clusters_[i].keys.size()) return i;
  return kUnassigned;
}

template <class State>
std::vector<TrackKey> MultipleHypotheses<State>::keys() const {
  std::vector<TrackKey> keys;
  for (const Cluster& cluster : clusters_) keys.insert(keys.end(), cluster.keys.begin(), cluster.keys.end());
  return keys;
}

template <class State>
void MultipleHypotheses<State>::add(TrackKey key, const State& state) {
  assert(!has(key));
  clusters_.push_back({{key}, {{0.0, {state}, {kUnassigned}, {}}}, false, {}});
}

template <class State>
void MultipleHypotheses<State>::remove(TrackKey key) {
  const std::size_t index = cluster_of(key);
  if (index == kUnassigned) return;
  Cluster& cluster = clusters_[index];
  const auto place = static_cast<std::ptrdiff_t>(place_in(cluster, key));
  cluster.keys.erase(cluster.keys.begin() + place);
  for (Joint& one : cluster.hypotheses) {
    one.states.erase(one.states.begin() + place);
    one.measurements.erase(one.measurements.begin() + place);
  }
  if (cluster.keys.empty()) clusters_.erase(clusters_.begin() + static_cast<std::ptrdiff_t>(index));
}

template <class State>
const State& MultipleHypotheses<State>::best(TrackKey key) const {
  const Cluster& cluster = clusters_[cluster_of(key)];
  return cluster.hypotheses.front().states[place_in(cluster, key)];
}

template <class State>
void MultipleHypotheses<State>::set_best(TrackKey key, const State& state) {
  Cluster& cluster = clusters_[cluster_of(key)];
  cluster.hypotheses.front().states[place_in(cluster, key)] = state;
}

template <class State>
std::size_t MultipleHypotheses<State>::measurement_of(TrackKey key) const {
  const Cluster& cluster = clusters_[cluster_of(key)];
  return cluster.hypotheses.front().measurements[place_in(cluster, key)];
}

template <class State>
template <class Change>
void MultipleHypotheses<State>::change_alternatives(const Change& change) {
  for (Cluster& cluster : clusters_)
    for (std::size_t i = 1; i < cluster.hypotheses.size(); ++i)
      for (std::size_t t = 0; t < cluster.keys.size(); ++t) change(cluster.keys[t], cluster.hypotheses[i].states[t]);
}

template <class State>
template <ScanOfTracks<State> Model>
void MultipleHypotheses<State>::step(const Model& model) {
  join_clusters(model);
  for (Cluster& cluster : clusters_) advance(model, cluster);
  split_decided(model);
}

template <class State>
template <class Model>
void MultipleHypotheses<State>::find_gated(const Model& model, Cluster& cluster) const {
  cluster.gated.assign(model.measurement_count(), 0);
  for (const Joint& one : cluster.hypotheses)
    for (std::size_t t = 0; t < cluster.keys.size(); ++t)
      for (std::size_t measurement = 0; measurement < cluster.gated.size(); ++measurement)
        if (!cluster.gated[measurement] && model.pair_cost(cluster.keys[t], one.states[t], measurement, 0) < kForbidden) cluster.gated[measurement] = 1;
}

/// Joins clusters that may have the same measurement.
template <class State>
template <class Model>
void MultipleHypotheses<State>::join_clusters(const Model& model) {
  for (Cluster& cluster : clusters_) find_gated(model, cluster);
  for (std::size_t measurement = 0; measurement < model.measurement_count(); ++measurement) {
    std::size_t first = kUnassigned;
    for (std::size_t c = 0; c < clusters_.size();) {
      if (!clusters_[c].gated[measurement]) {
        ++c;
      } else if (first == kUnassigned) {
        first = c++;
      } else {
        join(clusters_[first], clusters_[c]);
        clusters_.erase(clusters_.begin() + static_cast<std::ptrdiff_t>(c));
      }
    }
  }
}

/// The best pairs of hypotheses of both.
template <class State>
void MultipleHypotheses<State>::join(Cluster& into, const Cluster& other) const {
  const bool is_large = into.keys.size() + other.keys.size() > config_.most_tracks;
  std::vector<Joint> pairs;
  for (const Joint& a : into.hypotheses) {
    for (const Joint& b : other.hypotheses) {
      Joint both = a;
      both.cost += b.cost;
      both.states.insert(both.states.end(), b.states.begin(), b.states.end());
      both.measurements.insert(both.measurements.end(), b.measurements.begin(), b.measurements.end());
      pairs.push_back(std::move(both));
      if (is_large) break;
    }
    if (is_large) break;
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Joint& a, const Joint& b) { return a.cost < b.cost; });
  if (pairs.size() > config_.most_hypotheses) pairs.resize(config_.most_hypotheses);
  for (Joint& one : pairs) one.lineage.clear();  // of two pasts; what is ambiguous now stays so for scans_back from now
  into.hypotheses = std::move(pairs);
  into.keys.insert(into.keys.end(), other.keys.begin(), other.keys.end());
  for (std::size_t measurement = 0; measurement < into.gated.size(); ++measurement) into.gated[measurement] |= other.gated[measurement];
}

template <class State>
template <class Model>
void MultipleHypotheses<State>::find_children(const Model& model, const Cluster& cluster) {
  columns_.clear();
  occurrence_.clear();
  for (std::size_t measurement = 0; measurement < model.measurement_count(); ++measurement) {
    if (!cluster.gated[measurement]) continue;
    const std::size_t capacity = std::min<std::size_t>(model.capacity(measurement), cluster.keys.size());
    for (std::size_t i = 0; i < capacity; ++i) columns_.push_back(measurement), occurrence_.push_back(i);
  }
  const bool is_large = cluster.keys.size() > config_.most_tracks;
  children_.clear();
  for (std::size_t parent = 0; parent < cluster.hypotheses.size(); ++parent) {
    const Joint& one = cluster.hypotheses[parent];
    costs_.rows = cluster.keys.size();
    costs_.columns = columns_.size();
    costs_.cost.resize(costs_.rows * costs_.columns);
    double cost_of_all_missed = 0.0;  // pairs count against it, so that leaving any track out is free
    for (std::size_t t = 0; t < costs_.rows; ++t) {
      const double miss_cost = model.miss_cost(cluster.keys[t], one.states[t]);
      cost_of_all_missed += miss_cost;
      for (std::size_t j = 0; j < costs_.columns; ++j)
        costs_(t, j) = model.pair_cost(cluster.keys[t], one.states[t], columns_[j], occurrence_[j]) - miss_cost;
    }
    for (const RankedAssignment& ranked : ranking_.rank(costs_, 0.0, is_large ? 1 : config_.most_children))
      children_.push_back({one.cost + cost_of_all_missed + ranked.cost, parent, ranked.column_of_row});
  }
  std::stable_sort(children_.begin(), children_.end(), [](const Child& a, const Child& b) { return a.cost < b.cost; });
  const double most_cost = children_.front().cost + config_.most_cost_above_best;
  while (children_.back().cost > most_cost) children_.pop_back();
  const std::size_t most = is_large ? 1 : config_.most_hypotheses;
  if (children_.size() > most) children_.resize(most);
}

template <class State>
template <class Model>
auto MultipleHypotheses<State>::grown(const Model& model, const Cluster& cluster, const Child& child) -> Joint {
  const Joint& parent = cluster.hypotheses[child.parent];
  Joint next;
  next.cost = child.cost;
  for (const std::size_t column : child.column_of_row)
    next.measurements.push_back(column == kUnassigned ? kUnassigned : columns_[column]);
  for (std::size_t t = 0; t < cluster.keys.size(); ++t) {
    const std::size_t measurement = next.measurements[t];
    if (measurement == kUnassigned) {
      next.states.push_back(model.missed(cluster.keys[t], parent.states[t]));
    } else {
      const auto sharers = static_cast<std::size_t>(std::count(next.measurements.begin(), next.measurements.end(), measurement));
      next.states.push_back(model.updated(cluster.keys[t], parent.states[t], measurement, sharers - 1));
    }
  }
  next.lineage = parent.lineage;
  next.lineage.push_back(next_name_++);
  return next;
}

template <class State>
template <class Model>
void MultipleHypotheses<State>::advance(const Model& model, Cluster& cluster) {
  find_children(model, cluster);
  const double least_cost = children_.front().cost;
  cluster.is_revised = children_.front().parent != 0;
  std::vector<Joint> next;
  for (const Child& child : children_) {
    next.push_back(grown(model, cluster, child));
    next.back().cost -= least_cost;
  }
  merge_same(model, next);
  prune_by_age(next);
  cluster.hypotheses = std::move(next);
}

/// Of hypotheses that have come to the same the more probable is kept, with the probability of both.
template <class State>
template <class Model>
void MultipleHypotheses<State>::merge_same(const Model& model, std::vector<Joint>& hypotheses) const {
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    for (std::size_t j = i + 1; j < hypotheses.size();) {
      const bool is_same = std::equal(hypotheses[i].states.begin(), hypotheses[i].states.end(), hypotheses[j].states.begin(),
                                      [&](const State& a, const State& b) { return model.are_same(a, b); });
      if (!is_same) {
        ++j;
        continue;
      }
      hypotheses[i].cost -= 2.0 * std::log1p(std::exp(-0.5 * (hypotheses[j].cost - hypotheses[i].cost)));
      hypotheses.erase(hypotheses.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
  // What was likeliest stays in front, so that what is published changes only when a measurement speaks for another past.
  std::stable_sort(hypotheses.begin() + 1, hypotheses.end(), [](const Joint& a, const Joint& b) { return a.cost < b.cost; });
}

/// N-scan pruning: the best hypothesis' decision of that long ago is final.
template <class State>
void MultipleHypotheses<State>::prune_by_age(std::vector<Joint>& hypotheses) const {
  if (hypotheses.front().lineage.size() <= config_.scans_back) return;
  const std::uint32_t ancestor = hypotheses.front().lineage.front();
  std::erase_if(hypotheses, [&](const Joint& one) { return one.lineage.front() != ancestor; });
  for (Joint& one : hypotheses) one.lineage.erase(one.lineage.begin());
}

/// Tracks on which all hypotheses of a cluster agree are clusters of their own again.
template <class State>
template <class Model>
void MultipleHypotheses<State>::split_decided(const Model& model) {
  for (std::size_t c = 0, count = clusters_.size(); c < count; ++c) {
    for (std::size_t t = 0; t < clusters_[c].keys.size() && clusters_[c].keys.size() > 1;) {
      Cluster& cluster = clusters_[c];
      const Joint& best = cluster.hypotheses.front();
      const bool is_decided = std::all_of(cluster.hypotheses.begin(), cluster.hypotheses.end(),
                                          [&](const Joint& one) { return model.are_same(best.states[t], one.states[t]); });
      if (!is_decided) {
        ++t;
        continue;
      }
      Cluster alone{{cluster.keys[t]}, {{0.0, {best.states[t]}, {best.measurements[t]}, {}}}, cluster.is_revised, {}};
      remove(cluster.keys[t]);
      clusters_.push_back(std::move(alone));
    }
  }
}

}  // namespace slammot::association
