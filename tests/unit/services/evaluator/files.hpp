#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace slammot::evaluator {

inline void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A drive of 30 s along x at 10 m/s with a pose every 0.1 s, from the given start.
inline std::string straight_tum(double start_x_m, double first_stamp_s = 0.0) {
  std::string text;
  for (int i = 0; i <= 300; ++i) {
    char line[96];
    std::snprintf(line, sizeof line, "%.6f %.6f 0 0 0 0 0 1\n", first_stamp_s + 0.1 * i,
                  start_x_m + i);
    text += line;
  }
  return text;
}

/// A car 10 m ahead of that drive, in each scan.
inline std::string car_ahead_csv(double start_x_m) {
  std::string text = "timestamp,id,class,x,y,yaw,speed,length,width,points,range\n";
  for (int i = 0; i <= 300; ++i) {
    char line[128];
    std::snprintf(line, sizeof line, "%.6f,1,car,%.3f,0,0,10,4.5,1.8,20,10\n", 0.1 * i,
                  start_x_m + i + 10.0);
    text += line;
  }
  return text;
}

/// The track of that car with a lateral error.
inline std::string tracks_csv(double start_x_m, double error_m) {
  std::string text = "timestamp,track_id,x,y,heading,vx,vy,length,width,motion,existence,class\n";
  for (int i = 0; i <= 300; ++i) {
    char line[128];
    std::snprintf(line, sizeof line, "%.6f,7,%.3f,%.3f,0,10,0,4.5,1.8,moving,1,car\n", 0.1 * i,
                  start_x_m + i + 10.0, error_m);
    text += line;
  }
  return text;
}

}  // namespace slammot::evaluator
