/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_privacy.h"

#include <math.h>

#include "text/json_text.h"
#include "vision/privacy.h"

const char *privacy_words_before(const ReviewCase *c)
{
    static const char *const WORDS[4] = {
        [VERDICT_PASS] = "must not be read, and surely cannot be: ",
        [VERDICT_FAIL] = "must not be read, but can be: ",
        [VERDICT_TOO_CLOSE] = "must not be read, and perhaps can be: ",
        [VERDICT_UNJUDGED] = "must not be read: "};
    return c->must_not_be_read ? WORDS[c->verdict] : "";
}

PrivacyFigures privacy_figures(const ReviewCase *c)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    double white = fmax(l->foreground, l->background);
    double black = fmin(l->foreground, l->background);
    double v = privacy_security(white, black, l->reflected);
    return (PrivacyFigures){v, privacy_security_of_contrast(c->contrast_high),
                            privacy_security_of_contrast(c->contrast_low), privacy_s(v),
                            privacy_s_of_contrast(c->contrast_high),
                            privacy_s_of_contrast(c->contrast_low)};
}

static void set_figure(json_t *to, const char *key, double value)
{
    json_object_set_new(to, key, json_figure(value));
}

static void set_interval(json_t *to, const char *key, double low, double high)
{
    json_object_set_new(to, key, json_pack("[o,o]", json_figure(low), json_figure(high)));
}

json_t *privacy_json(const ReviewCase *c)
{
    PrivacyFigures of = privacy_figures(c);
    const char    *by = kept_names[case_kept_by(c)];
    if (!c->must_not_be_read) return NULL;
    json_t *out = json_pack("{s:o}", "kept_by", by ? json_text(by) : json_null());
    set_figure(out, "visual_security", of.v);
    set_interval(out, "visual_security_interval", of.v_low, of.v_high);
    set_figure(out, "s", of.s);
    set_interval(out, "s_interval", of.s_low, of.s_high);
    return out;
}
