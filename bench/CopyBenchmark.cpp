// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>
#include <csom/io/LabelSet.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <vector>

#include "Benchmarks.h"
#include "MapOptions.h"

namespace csom::bench {

namespace {

/// Just over 100,000 known voxels, if the scans have so many.
SemanticMap mapToCopy(const std::vector<Scan>& scans) {
  constexpr std::size_t kVoxels = 100000;
  constexpr std::size_t kPoints = 1000;
  SemanticMap map(mapOptions());
  for (const Scan& scan : scans) {
    for (std::size_t begin = 0; begin < scan.points.size(); begin += kPoints) {
      if (map.knownVoxelCount() >= kVoxels) return map;
      const std::size_t end = std::min(begin + kPoints, scan.points.size());
      Scan part;
      part.origin = scan.origin;
      for (std::size_t i = begin; i < end; ++i) {
        part.points.push_back(scan.points[i]);
        part.labels.push_back(scan.labels[i]);
      }
      map.insert(part);
    }
  }
  return map;
}

void copyByConstructor(benchmark::State& state, const std::vector<Scan>& scans) {
  const SemanticMap map = mapToCopy(scans);
  for (auto _ : state) {
    SemanticMap copy(map);
    benchmark::DoNotOptimize(copy);
  }
  state.counters["voxels"] = static_cast<double>(map.knownVoxelCount());
}

void copyByStream(benchmark::State& state, const std::vector<Scan>& scans) {
  CSemanticContinuousMap map;
  MapDocument document;
  document.map = mapToCopy(scans);
  document.labels = LabelSet::load(LabelSet::find("semantickitti"));
  map.setDocument(std::move(document));
  for (auto _ : state) {
    mrpt::io::CMemoryStream stream;
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive << map;
    stream.Seek(0);
    CSemanticContinuousMap copy;
    archive >> copy;
    benchmark::DoNotOptimize(copy);
  }
  state.counters["voxels"] = static_cast<double>(map.map().knownVoxelCount());
}

}  // namespace

void registerCopies(const std::vector<Scan>& scans) {
  const auto add = [&scans](const char* name, auto copy) {
    benchmark::RegisterBenchmark(name, [copy, &scans](benchmark::State& state) {
      copy(state, scans);
    })->Unit(benchmark::kMicrosecond);
  };
  add("copy/constructor", copyByConstructor);
  add("copy/stream", copyByStream);
}

}  // namespace csom::bench
