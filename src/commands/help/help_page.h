#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace mssim {

/// How --help looks: usage, commands or options with a word for their value, and lines that fit a terminal.
class HelpPage final : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
};

/// The page of `app`, whose name a user types as `name`.
std::string help_page(const CLI::App& app, const std::string& name);

}  // namespace mssim
