// SPDX-License-Identifier: BSD-3-Clause
// saveMap(): a document into the tables of a map file.
#include <csom/core/Error.h>
#include <csom/io/MapFile.h>
#include <csom/io/OutputFile.h>

#include <stdexcept>

#include "ChunkCodec.h"
#include "MapSchema.h"
#include "Sqlite.h"

namespace csom {

namespace {

using detail::Database;
using detail::Statement;

void writeMeta(const Database& database, const MapDocument& document) {
  Statement insert(database, "INSERT INTO meta VALUES (?, ?)");
  for (const auto& [key, value] : document.meta) {
    if (key != detail::kDigestKey && key != detail::kChecksumKey)
      insert.bind(1, key).bind(2, value).run();
  }
  insert.bind(1, detail::kDigestKey).bind(2, mapDigest(document.map)).run();
  insert.bind(1, detail::kChecksumKey).bind(2, detail::descriptionChecksum(document)).run();
}

void writeOptions(const Database& database, const Options& options) {
  Statement insert(database, "INSERT INTO options VALUES (?, ?)");
  visitOptions(options, [&](const char* name, const auto& field, const char*, const char*) {
    insert.bind(1, name).bind(2, toString(field)).run();
  });
}

void bindValue(Statement& statement, int parameter, double value) {
  statement.bind(parameter, value);
}
void bindValue(Statement& statement, int parameter, std::size_t value) {
  statement.bind(parameter, static_cast<std::int64_t>(value));
}

void writeScans(const Database& database, const std::vector<ScanRecord>& scans) {
  const std::string columns = detail::scanColumns();
  std::string parameters = "?";
  for (const char c : columns)
    if (c == ',') parameters += ", ?";
  Statement insert(database, "INSERT INTO scans (" + columns + ") VALUES (" + parameters + ")");
  for (const ScanRecord& scan : scans) {
    int parameter = 0;
    insert.bind(++parameter, scan.timestamp);
    insert.bind(++parameter, scan.sensor_label);
    insert.bind(++parameter, scan.observation_class);
    for (const double coordinate : scan.origin) insert.bind(++parameter, coordinate);
    visitReport(scan.report, [&](const std::string&, const auto& field) {
      bindValue(insert, ++parameter, field);
    });
    insert.run();
  }
}

void writeChunks(const Database& database, const ChunkStore& chunks) {
  Statement insert(database, "INSERT INTO chunks (x, y, z, hash, record) VALUES (?, ?, ?, ?, ?)");
  detail::ChunkCodec codec;
  for (const auto& [index, chunk] : chunks.sorted()) {
    const std::string_view frame = codec.compress(chunk->record(), chunk->recordSize());
    insert.bind(1, std::int64_t{index.x}).bind(2, std::int64_t{index.y});
    insert.bind(3, std::int64_t{index.z});
    insert.bind(4, static_cast<std::int64_t>(detail::hashOf(chunk->record(), chunk->recordSize())));
    insert.bindBlob(5, frame.data(), frame.size()).run();
  }
}

}  // namespace

void saveMap(const MapDocument& document, const std::string& file) {
  if (document.map.options().number_of_classes != document.labels.numberOfClasses())
    throw std::invalid_argument("saveMap: the map and its label set differ in number of classes");
  OutputFile output(file);
  if (output.isDirect()) throw FileError(file, "is not a regular file; a map needs one");

  Database database(output.path(), file, Database::Mode::ReadWrite);
  // The temporary file is worth nothing before it is complete, and is flushed once at the end.
  database.execute("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; BEGIN");
  database.execute(detail::createTables());
  writeMeta(database, document);
  writeOptions(database, document.map.options());
  Statement(database, "INSERT INTO labels VALUES (?)").bind(1, document.labels.toYaml()).run();
  writeScans(database, document.scans);
  writeChunks(database, document.map.chunks());
  database.execute("COMMIT");
  database.close();
  output.commit();
}

}  // namespace csom
