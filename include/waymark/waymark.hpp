// SPDX-License-Identifier: Apache-2.0
// The public header: nothing but includes.
#pragma once
