// SPDX-License-Identifier: BSD-3-Clause
// The comparison of methods as one page of plots.
#pragma once

#include <csom/protocols/Evaluation.h>

#include <string>

namespace csom {

/// HTML 5 text that needs nothing else: IoU over density (P1) and over repetition (P6), ROC curves
/// (P4, P5), confusion matrices with F1 (P3 and others), and the parameter study, each if the
/// evaluation has it. Every name is escaped.
std::string evaluationPage(const Evaluation& evaluation);

}  // namespace csom
