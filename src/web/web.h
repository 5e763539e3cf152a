#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "application/bench/bench_results.h"

namespace mssim {

/// The page of `mssim web`: one HTML file without anything beside it, which measures the device that opens it
/// (src/web/browser/). mssim puts in the laws of kernels/, the table of integrators, the scenes of Tables 1
/// and 3 of Hong et al. with their published times, and the numbers of verifications: tolerances, and the
/// reference's end on a small scene (SecondStretch). The page derives its WGSL and its JavaScript from them.
/// `served`: it offers to send its results to the server that it comes from. Throws like prepare_scene.
std::string web_page(bool served = false);

/// Whether the path is that of a file that the page may have saved: a JSON file, no folder and none
/// of a result folder.
bool is_web_results(const std::filesystem::path& path);

/// The rows of a file that the page has saved, {mssim_web_results, provenance, timings_csv, samples_csv}, as
/// if they were a folder's. Throws UsageError for a damaged or made-up file: rows whose numbers do not follow
/// from their samples.
MeasuredRun read_web_results(const std::filesystem::path& file);
/// Reads the rows of such a file's text; `file` is for messages. Throws like read_web_results.
MeasuredRun parse_web_results(const std::filesystem::path& file, const std::string& text);

/// Serves the page on this machine's loopback address until an ending signal, or with `once` until it has
/// taken a result. Makes the page when it has the port, so that a taken port is told first, and then prints
/// the address on stdout. `taken` gets the text of each result that the page sends, and returns what to
/// answer; what it throws is answered as an error. Port 0: any free one. Throws UsageError if the port is
/// taken, and like web_page.
void serve_page(int port, bool once, const std::function<std::string(const std::string& text)>& taken);

}  // namespace mssim
