/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/privacy_page.h"

#include <math.h>

#include "page/page.h"
#include "review/output/review_privacy.h"
#include "review/output/review_words.h"
#include "text/text.h"

void privacy_set_values(json_t *to, const ReviewCase *c, Arena *arena)
{
    PrivacyFigures of = privacy_figures(c);
    page_set_flag(to, "is_private", c->must_not_be_read);
    page_set(to, "places_drawn", privacy_places_drawn(c, arena));
    page_set(to, "security",
             !c->must_not_be_read || isnan(of.v)
                 ? NULL
                 : arena_format(arena, "V %s, S %s",
                                words_within(of.v, of.v_low, of.v_high, arena),
                                words_within(of.s, of.s_low, of.s_high, arena)));
    json_t *images = json_array();
    json_object_set_new(to, "private_images", images);
    for (int i = 0; i < c->image_count; i++) {
        json_t *image = page_add(images);
        page_set(image, "pane", c->images[i].pane);
        page_set(image, "told", privacy_image_words(&c->images[i], arena));
    }
}
