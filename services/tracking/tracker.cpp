#include "services/tracking/tracker.hpp"

#include <algorithm>

#include "services/tracking/initiation.hpp"
#include "services/tracking/labelling.hpp"
#include "services/tracking/merging.hpp"
#include "services/tracking/observing.hpp"
#include "services/tracking/occlusion.hpp"
#include "services/tracking/publication.hpp"
#include "services/tracking/reidentification.hpp"
#include "services/tracking/termination.hpp"
#include "services/tracking/track_initiation.hpp"
#include "services/tracking/track_update.hpp"

namespace slammot::tracking {
namespace {

constexpr double kOutlierScore = -0.5;  ///< Of a scan whose echoes a track refuses.

}  // namespace

Tracker::Tracker(const TrackingConfig& config, work::SideWork* help)
    : config_(config), estimation_{Associator(config), Formations(config), {}}, workspace_(help) {}

const TrackingResult& Tracker::step(const flow::SegmentedScan& scan) {
  begin_result(scan);
  if (scanners_.is_late(scan)) {
    ++counters_.late_scans;
    publish(scan);
    return result_;
  }
  ++counters_.scans;
  const double time_s = scanners_.begin(scan);
  if (scan.range_m.empty()) {
    coast(time_s);
    terminate();
    publish(scan);
    return result_;
  }
  result_.labels.restored.swap(scanners_.current().restored);
  current_.view.look_at(scan);
  const ComparedScan context{{current_.view, scanners_.current().history, config_},
                             current_.comparison};
  for (Track& track : tracks_) predict_to_beam(track, time_s, current_.view.polar(), config_);
  for (Track& track : tracks_) follow_occlusion(track, current_.view, config_);
  estimation_.associator.predict(time_s);
  compare(context);
  associate(context);
  update(context);
  if (config_.motion.formations) estimation_.formations.follow(tracks_, time_s);
  initiate(context);
  merge(context);
  identify(scan.stamp_ns);
  remember(context);
  terminate();
  publish(scan);
  estimation_.road_users.refresh();
  return result_;
}

void Tracker::begin_result(const flow::SegmentedScan& scan) {
  result_.labels.stamp_ns = scan.stamp_ns;
  result_.labels.sequence = scan.sequence;
  result_.labels.scanner_id = scan.scanner_id;
  result_.labels.labels = scan.labels;
  workspace_.resize(result_.labels.restored, 0);
}

/// Nothing was measured: tracks are predicted, and their existence does not change.
void Tracker::coast(double time_s) {
  for (Track& track : tracks_) {
    predict(track, time_s, config_);
    track.history.since_in_view_s += time_s;
  }
  estimation_.associator.predict(time_s);
  if (config_.motion.formations) estimation_.formations.follow(tracks_, time_s);
}

void Tracker::compare(const ScanContext& context) {
  current_.comparison.begin(context);
  workspace_.for_each_in_ranges(context.scan().segments.size(), [&](std::size_t segment) {
    current_.comparison.compare(segment, context);
  });
}

void Tracker::associate(const ComparedScan& context) {
  workspace_.resize(current_.associations.shares, tracks_.size());
  estimation_.associator.associate(tracks_, context, current_.associations);
}

/// What concerns other tracks is done afterwards, in the order of the tracks.
void Tracker::update(const ComparedScan& context) {
  const CurrentScanner scanner{scanners_.current_index(), scanners_.count() == 1};
  std::vector<TrackShare>& shares = current_.associations.shares;
  workspace_.for_each(tracks_.size(), [&](std::size_t t) {
    shares[t].outcome = update_track(tracks_[t], shares[t], context, scanner);
  });
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (shares[t].outcome == UpdateOutcome::kRejected) {
      tracks_[t].existence.score += kOutlierScore;
      release(current_.associations, t);
    }
    if (shares[t].outcome == UpdateOutcome::kConfirmable) confirm(tracks_[t]);
  }
}

void Tracker::confirm(Track& track) {
  tracking::confirm(track, scanners_.last_stamp_ns(), config_);
  // On a road a false track would excuse what stood in its place.
  if (only_people_move(config_)) {
    for (Scanner& scanner : scanners_.all()) scanner.history.confirm(track.track_id);
  }
  ++counters_.tracks_confirmed;
}

void Tracker::initiate(const ComparedScan& context) {
  Associations& associations = current_.associations;
  for (std::size_t s = 0; s < context.scan().segments.size(); ++s) {
    if (!may_initiate(s, tracks_, associations, context)) continue;
    workspace_.resize(tracks_, tracks_.size() + 1);
    workspace_.resize(associations.shares, tracks_.size());
    const Initiation initiation{
        {next_id_++}, s, scanners_.current_index(), estimation_.road_users.known()};
    initiate_from_segment(tracks_.back(), associations.shares.back(), initiation, context);
    associations.track_of_segment[s] = tracks_.size() - 1;
    ++counters_.tracks_begun;
  }
}

void Tracker::merge(const ComparedScan& context) {
  counters_.tracks_merged += join_parts(tracks_, current_.associations, context);
  counters_.tracks_merged += merge_duplicates(tracks_, current_.associations, config_);
}

/// An object about to be published for the first time may be one that was hidden.
void Tracker::identify(std::int64_t stamp_ns) {
  for (Track& track : tracks_) {
    if (track.history.first_published_ns || !is_published(track, stamp_ns, config_)) continue;
    const std::optional<std::size_t> lost = track_of_same_object(track, tracks_, config_);
    if (!lost) continue;
    continue_track(tracks_[*lost], track);
    ++counters_.tracks_found_again;
  }
}

/// Keeps of this scan what later scans need, and labels its points.
void Tracker::remember(const ComparedScan& context) {
  ScanHistory& history = scanners_.current().history;
  if (history.is_due(context.scan().stamp_ns)) {
    find_owners(tracks_, current_.associations, context, current_.owners);
    history.add(context.scan().stamp_ns, context.view.polar(), current_.owners);
  }
  label_beams(tracks_, current_.associations, context, result_.labels.labels);
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    keep_points(tracks_[t], current_.associations.shares[t].beams, scanners_.current_index(),
                context);
}

void Tracker::terminate() {
  workspace_.remove_if(tracks_, [&](const Track& track) {
    if (track.existence.hits == 0) return true;  // absorbed by another
    if (!has_ended(track, scanners_.last_stamp_ns(), config_)) return false;
    if (!track.existence.confirmed) give_back_points(track);
    estimation_.road_users.learn(track, config_);
    return true;
  });
  constexpr std::size_t kMostRestored = 64;
  if (result_.labels.restored.size() > kMostRestored)
    workspace_.resize(result_.labels.restored, kMostRestored);
  for (Scanner& scanner : scanners_.all()) {
    if (scanner.restored.size() > kMostRestored) workspace_.resize(scanner.restored, kMostRestored);
  }
}

/// The points of a rejected track, which were kept out of the map, are published with the next
/// labels of their scanner.
void Tracker::give_back_points(const Track& track) {
  ++counters_.tracks_rejected;
  for (const PastPoints& past : track.history.past_points.all()) {
    std::vector<flow::RestoredPoints>& restored = past.scanner == scanners_.current_index()
                                                      ? result_.labels.restored
                                                      : scanners_.all()[past.scanner].restored;
    const auto same = std::ranges::find_if(
        restored, [&](const auto& one) { return one.sequence == past.points.sequence; });
    counters_.points_restored += past.points.beams.size();
    if (same != restored.end()) {
      add_beams(same->beams, past.points.beams);
    } else {
      workspace_.resize(restored, restored.size() + 1);
      restored.back() = past.points;
    }
  }
}

void Tracker::publish(const flow::SegmentedScan& scan) {
  flow::TrackedObjects& objects = result_.objects;
  objects.stamp_ns = scan.stamp_ns;
  objects.sequence = scan.sequence;
  objects.map_from_odom = scan.map_from_odom;
  objects.odom_from_base = scan.odom_from_base.pose;
  objects.map_id = scan.map_id;
  objects.odom_id = scan.odom_id;
  workspace_.resize(objects.objects, tracks_.size());
  workspace_.for_each(tracks_.size(), [&](std::size_t t) {
    flow::TrackedObject& object = objects.objects[t];
    tracking::publish(tracks_[t], scan.stamp_ns, config_, object);
    if (object.confirmed && !tracks_[t].history.first_published_ns)
      tracks_[t].history.first_published_ns = scan.stamp_ns;
  });
}

void Tracker::resume(const flow::TrackedObjects& objects) {
  tracks_.clear();
  estimation_ = {Associator(config_), Formations(config_), {}};
  scanners_.reset(objects.stamp_ns);
  for (const flow::TrackedObject& object : objects.objects) {
    next_id_ = std::max(next_id_, object.track_id.value + 1);
    if (object.confirmed) tracks_.push_back(track_from_message(object, config_));
  }
  for (Track& track : tracks_)
    track.extent.footprint().road_users = &estimation_.road_users.known();
}

}  // namespace slammot::tracking
