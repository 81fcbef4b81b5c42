// SPDX-License-Identifier: BSD-3-Clause
// CSOM_ADDRESS_SANITIZED, CSOM_THREAD_SANITIZED: which sanitizer watches this code. GCC defines a
// macro for each, Clang has a question of its own.
#pragma once

#ifdef __has_feature
#define CSOM_HAS_FEATURE(feature) __has_feature(feature)
#else
#define CSOM_HAS_FEATURE(feature) 0
#endif

#if defined(__SANITIZE_ADDRESS__) || CSOM_HAS_FEATURE(address_sanitizer)
#define CSOM_ADDRESS_SANITIZED
#endif
#if defined(__SANITIZE_THREAD__) || CSOM_HAS_FEATURE(thread_sanitizer)
#define CSOM_THREAD_SANITIZED
#endif
