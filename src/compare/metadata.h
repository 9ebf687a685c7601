/* metadata.h -- the attributes of two frames side by side; private to structure.c. */
#pragma once
#include "compare/structure.h"

/* Every key of either frame, once each, those of the reference first. */
MetadataRow *metadata_compare(const FrameImage *reference, const FrameImage *test,
                              const StructureRules *rules, Arena *arena, int *count);

/* One line for each row that differs: a reason when it decides what the picture shows. */
void metadata_report(const MetadataRow *rows, int count, bool strict, Lines *reasons,
                     Lines *notes);
