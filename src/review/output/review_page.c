/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_page.h"

#include <math.h>

#include "page/page.h"
#include "review/output/review_answer.h"
#include "review/output/review_gaze.h"
#include "review/output/review_table.h"
#include "review/output/review_variants.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/text.h"

#define PAGE_BYTES ((size_t)4 << 30) /* address space for the text */
#define WORDS_BYTES ((size_t)1 << 30)
#define OPEN_SWEEPS 1
#define RENEWED_S 15 /* a page to which something is to come */
#define SUMMARY_ROWS 5 /* verdicts that fit on one page of paper */

/* review.css and review.js beside this file; the build embeds them. */
extern const char REVIEW_STYLE[], REVIEW_SCRIPT[];
/* The interactive parts: review_live.css, review_live.js, review_look.js. */
extern const char LIVE_STYLE[], LIVE_SCRIPT[], LOOK_SCRIPT[];

/* ---- the answer ------------------------------------------------------------------------- */

static ReviewAnswer answer_of(const ReviewPage *page)
{
    return (ReviewAnswer){page->review, page->pictures, page->picture_count, page->maps,
                          page->map_count};
}

/* What a page about one symbol alone is about; NULL: it is about all. */
static const char *only_symbol(const Review *review)
{
    if (!review->whole) return NULL;
    return review->case_count ? review->cases[0].symbol
           : review->sweep_count ? review->sweeps[0].symbol : NULL;
}

/* Returns the review's title. */
static const char *begin_page(Text *html, const ReviewPage *page, int renewed_s, Arena *arena)
{
    const char *given = page->review->title;
    const char *title = given && given[0] ? given : "Glare review";
    const char *symbol = only_symbol(page->review);
    const char *style = arena_format(arena, "%s%s", REVIEW_STYLE, LIVE_STYLE);
    page_begin(html, &(PageHead){symbol ? symbol : title, style, page->is_dark, renewed_s});
    return title;
}

static bool add_head(Text *html, const ReviewPage *page, Arena *arena, Error *err)
{
    const Review *review = page->review;
    const char   *title = begin_page(html, page, review->to_come ? RENEWED_S : 0, arena);
    if (review->to_come)
        page_element(html, "p class=\"provisional\" role=\"status\"",
                     arena_format(arena, "Provisional: %s. This page renews itself until all "
                                         "is there.", review->to_come));
    page_element(html, "p class=\"sub title\"",
                 arena_format(arena, "%s · limits: %s%s", title,
                              review->profile ? review->profile : "none",
                              review->is_strict ? " · strict: what is too close fails, too"
                                                : ""));
    ReviewAnswer answer = answer_of(page);
    return review_answer_add(html, &answer, arena, err);
}

/* ---- verdicts --------------------------------------------------------------------------- */

static void add_verdicts(Text *html, const ReviewPage *page, Arena *arena)
{
    const Review *review = page->review;
    int           rows = review_case_count(review);
    if (rows == 0) return;
    page_more_begin(html, arena_format(arena, "Every verdict: %d", rows));
    text_add(html, "<p class=\"sub\">Contrast is how many times brighter the bright part of "
             "a symbol is than its dark part, with all reflections on both; the margin is how "
             "far the figure is above (+) or below (−) its limit: at −100 % nothing can be "
             "read, whatever the limit is. ✓ passes, ✗ fails, ≈ too close to call, ∅ cannot "
             "be judged; below it the 95 % interval and the limit.</p>\n");
    review_table_add_matrix(html, review, arena);
    review_table_add_list(html, review, 0, arena);
    page_more_end(html);
}

static void add_diff(Text *html, const ReviewPage *page, Arena *arena)
{
    if (!page->diff) return;
    page_element(html, "h2", "What changed");
    review_table_add_diff(html, page->diff, arena);
}

/* ---- cases ------------------------------------------------------------------------------ */

static bool add_card(Text *html, const ReviewPage *page, const ReviewCase *c, bool is_open,
                     Arena *arena, Error *err)
{
    ReviewAnswer answer = answer_of(page);
    ReviewCard   card = {.of = c, .id = review_card_id(page->review, c, arena),
                         .is_open = is_open,
                         .directions = review_answer_directions(&answer, c, arena),
                         .pictures = page->pictures, .picture_count = page->picture_count};
    return review_card_add(html, &card, arena, err);
}

/* A link to where the others are; nothing where all are here. */
static void add_others(Text *html, const Review *review, int count, const char *what,
                       Arena *arena)
{
    if (count == 0) return;
    text_format(html, "<p class=\"sub\"><a href=\"%s\">",
                review->is_beside ? "index.html" : REVIEW_PAGE_BESIDE);
    escape_markup(html, arena_format(arena, "%d more %s: %s", count, what,
                                     review->is_beside ? "the worst" : "a page of their own"));
    text_add(html, "</a></p>\n");
}

/* Those of the page in hand, the worst first. */
typedef struct CardList {
    const ReviewCase **list;
    int                count, passing, elsewhere;
} CardList;

static CardList list_cards(const Review *review, bool of_sweeps, Arena *arena)
{
    int                all = review_case_count(review);
    const ReviewCase **ranked = review_rank(review, arena);
    CardList           cards = {.list = ARENA_NEW(arena, const ReviewCase *, all)};
    for (int i = 0; i < all; i++) {
        bool is_here = !review->main_cards || (i < review->main_cards) != review->is_beside;
        if ((review_sweep_of(review, ranked[i]) != NULL) != of_sweeps) continue;
        cards.elsewhere += !is_here;
        if (!is_here) continue;
        cards.list[cards.count++] = ranked[i];
        cards.passing += ranked[i]->verdict == VERDICT_PASS;
    }
    return cards;
}

static bool add_cases(Text *html, const ReviewPage *page, Arena *arena, Error *err)
{
    CardList cards = list_cards(page->review, false, arena);
    int      not_passing = cards.count - cards.passing;
    if (cards.count + cards.elsewhere == 0) return true;
    page_more_begin(html, arena_format(arena, "Every case, worst first: %d",
                                       cards.count + cards.elsewhere));
    for (int i = 0; i < cards.count; i++) {
        if (i > 0 && i == not_passing)
            page_more_begin(html, arena_format(arena, "%d that pass%s", cards.passing,
                                               cards.passing == 1 ? "es" : ""));
        if (!add_card(html, page, cards.list[i], i == 0, arena, err)) return false;
    }
    if (cards.passing > 0 && not_passing > 0) page_more_end(html);
    add_others(html, page->review, cards.elsewhere, "cases", arena);
    page_more_end(html);
    return true;
}

/* ---- sweeps ----------------------------------------------------------------------------- */

static void add_sweep_keys(Text *html, const ReviewSweep *s, Arena *arena)
{
    bool is_sure = sweep_verdict(s) == VERDICT_FAIL, has_box = sweep_has_box(s);
    const char *of = words_of_what(s), *whose = has_box ? "the middle eye" : "it";
    page_keys_begin(html);
    if (has_box)
        page_key(html, words_share(s->worst.eye_failed_share, arena),
                 "of eyes fail at its worst", s->worst.eye_failed_share > 0);
    page_key(html, words_share(s->failed_share, arena),
             is_sure || !(s->failed_share > 0)
                 ? arena_format(arena, "%s %s fails", of, whose)
                 : arena_format(arena, "%s by %s steps alone: not confirmed", of,
                                has_box ? "the middle eye's" : "its"),
             is_sure && s->failed_share > 0);
    if (!isnan(s->longest_failure_minutes))
        page_key(html, words_minutes(s->longest_failure_minutes, arena),
                 has_box ? "the middle eye's longest failure at a stretch"
                         : "the longest failure at a stretch", s->longest_failure_minutes > 0);
    if (has_box && s->middle_contrast > 0)
        page_key(html, words_ratio_as(&s->worst, s->middle_contrast, arena),
                 "of the middle eye at its own worst", false);
    page_key(html, words_judged(&s->worst, arena), has_box ? "of the worst eye at its worst"
                                                           : "at its worst",
             s->worst.verdict != VERDICT_PASS);
    page_key(html, arena_format(arena, "%ld", s->cases), "suns and hours judged", false);
    page_keys_end(html);
}

static bool add_sweep_figures(Text *html, const ReviewPage *page, const ReviewSweep *s,
                              Arena *arena, Error *err)
{
    text_add(html, "<div class=\"sweeps\">\n");
    for (int i = 0; i < page->map_count; i++)
        if (page->maps[i].of == s && !review_map_add(html, &page->maps[i], arena, err))
            return false;
    for (int i = 0; i < page->calendar_count; i++)
        if (page->calendars[i].of == s &&
            !review_map_add_calendar(html, &page->calendars[i], arena, err))
            return false;
    text_add(html, "</div>\n");
    return true;
}

static void add_sweep_line(Text *html, const ReviewSweep *s, bool is_open, Arena *arena)
{
    Verdict verdict = sweep_verdict(s);
    text_format(html, "<details class=\"case %s\"%s><summary>", words_class(verdict),
                is_open ? " open" : "");
    review_card_add_chip(html, verdict);
    text_add(html, " ");
    page_element(html, "b", s->symbol ? s->symbol : "?");
    page_element(html, "span class=\"where\"",
                 arena_format(arena, "seen by %s: %s", s->eye ? s->eye : "?",
                              s->condition ? s->condition : "?"));
    text_format(html, "<span class=\"ratio\">%s · worst %s</span></summary>\n",
                words_how_often(s, arena), words_judged(&s->worst, arena));
}

static bool add_sweep(Text *html, const ReviewPage *page, const ReviewSweep *s, bool is_open,
                      Arena *arena, Error *err)
{
    add_sweep_line(html, s, is_open, arena);
    text_add(html, "<section>");
    add_sweep_keys(html, s, arena);
    if (!add_sweep_figures(html, page, s, arena, err)) return false;
    page_element(html, "h4", "At its worst");
    if (!add_card(html, page, &s->worst, false, arena, err))
        return false;
    if (s->table)
        page_element(html, "p class=\"sub\"",
                     arena_format(arena, "All of it as a table: %s", s->table));
    text_add(html, "</section></details>\n");
    return true;
}

static void add_how_often(Text *html, const Review *review, Arena *arena)
{
    page_more_begin(html, arena_format(arena, "How often each symbol fails, and its least "
                                       "contrast: %d sweep%s", review->sweep_count,
                                       review->sweep_count == 1 ? "" : "s"));
    review_table_add_sweeps(html, review, arena);
    page_more_end(html);
}

/* The worst is open; all others are a line each. */
static bool add_sweeps(Text *html, const ReviewPage *page, Arena *arena, Error *err)
{
    const Review *review = page->review;
    CardList      cards = list_cards(review, true, arena);
    int           not_passing = cards.count - cards.passing;
    bool          has_more = false;
    if (review->sweep_count == 0) return true;
    page_element(html, "h2", "Every sun, every hour");
    if (!review->is_beside) add_how_often(html, review, arena);
    for (int i = 0; i < cards.count; i++) {
        bool is_passing = i >= not_passing;
        if (i == OPEN_SWEEPS || (i > 0 && i == not_passing)) {
            int left = is_passing ? cards.passing : not_passing - i;
            if (has_more) page_more_end(html);
            const char *word = is_passing ? "that pass" : "more that do not pass";
            page_more_begin(html, arena_format(arena, "%d %s%s", left, word,
                                               is_passing && left == 1 ? "es" : ""));
            has_more = true;
        }
        const ReviewSweep *s = review_sweep_of(review, cards.list[i]);
        if (!add_sweep(html, page, s, i < OPEN_SWEEPS, arena, err)) return false;
    }
    if (has_more) page_more_end(html);
    add_others(html, review, cards.elsewhere, "sweeps", arena);
    return true;
}

/* ---- what stands behind it -------------------------------------------------------------- */

static const char *size_words(long bytes, Arena *arena)
{
    double size = (double)bytes;
    return size < 1e6 ? arena_format(arena, "%s kB", words_figure(size / 1e3, arena))
                      : arena_format(arena, "%s MB", words_figure(size / 1e6, arena));
}

static void add_responses(Text *html, const Review *review, Arena *arena)
{
    static const PageColumn COLUMNS[] = {{"Question", false, NULL}, {"Light paths", true, NULL},
                                         {"Size", true, NULL},
                                         {"Error", true, "relative standard error"}};
    if (review->response_count == 0) return;
    page_more_begin(html, arena_format(arena, "What was traced: %d questions to the light",
                                       review->response_count));
    page_table_begin(html, "", "", COLUMNS, 4);
    for (int i = 0; i < review->response_count; i++) {
        const ReviewResponse *r = &review->responses[i];
        page_row_begin(html, "");
        page_cell(html, "", r->probe);
        page_cell_format(html, "n", "%ld", r->paths);
        page_cell(html, "n", size_words(r->bytes, arena));
        page_cell(html, "n", words_share(r->relative_error, arena));
        page_row_end(html);
    }
    page_table_end(html);
    page_more_end(html);
}

static void add_provenance(Text *html, const ReviewPage *page, Arena *arena)
{
    const Review *review = page->review;
    page_more_begin(html, "Where the limits come from, and what it was made of");
    page_element(html, "h2", "Where the limits come from");
    page_element(html, "p class=\"sub\"", review->profile ? review->profile : "No profile.");
    review_table_add_limits(html, review, arena);
    page_element(html, "h2", "What it was made of");
    text_add(html, "<dl class=\"facts made\">\n");
    for (int i = 0; i < page->fact_count; i++)
        page_fact(html, page->facts[i].name, page->facts[i].value);
    text_add(html, "</dl>\n");
    add_responses(html, review, arena);
    if (page->command_count) page_element(html, "h3", "Commands");
    for (int i = 0; i < page->command_count; i++)
        page_element(html, "pre", page->commands[i]);
    page_more_end(html);
}

static void add_notes(Text *html, const Review *review, Arena *arena)
{
    page_element(html, "h2", "How it was made");
    if (review->note_count == 0) return;
    page_more_begin(html, arena_format(arena, "What a reader must know: %d",
                                       review->note_count));
    page_list(html, "notes", review->notes, review->note_count);
    page_more_end(html);
}

static void add_glossary(Text *html)
{
    static const char *const WORDS[][2] = {
        {"cd/m²", "candela per square metre: how bright a surface looks. A white page in the "
                  "office has about 100, in the sun 30 000."},
        {"lx", "lux: how much light falls on a surface. An office desk has 500, a display in "
               "the sun up to 100 000."},
        {"contrast", "the bright part's light to the eye over the dark part's, both with what "
                     "the display reflects. 1 : 1 is nothing to see."},
        {"limit, margin", "what a standard requires, and how far the figure is from it: 0 % "
                          "lies on the limit, −100 % is full wash-out, where nothing stands "
                          "out. Contrasts count by the logarithm of their ratio: at +100 % it "
                          "is the square of what is required."},
        {"95 % interval", "the calculation is made of random samples: with 95 % certainty, or "
                          "more, the interval holds what endless samples would give, of "
                          "a panel that is as far from the truth as it says of itself."},
        {"too close to call", "the limit lies inside that interval."},
        {"cannot be judged", "something is not known: nothing of the symbol is seen, its "
                             "panel says that it is not usable, more than a tenth of the "
                             "light comes via materials without optical data, or no limit "
                             "applies. What need not be seen, or has no limit, does not "
                             "count."},
        {"reflected as in a mirror", "a picture of what stands opposite: sky, seat, shirt."},
        {"scattered", "light that the display's surface spreads: the sun need not stand in the "
                      "mirror's direction."},
        {"veil", "light from elsewhere that the eye itself scatters over what it looks at; it "
                 "grows with age."},
        {"the sun in mirrors", "an image of the sun in something smooth. The eye sees it as "
                               "bright as the sun itself, less what the mirror takes."},
        {"contrast left", "how much of the contrast between a distant object and what is "
                          "around it remains behind what the glass mirrors and the veil in "
                          "the eye: all of it is 100 %."},
        {"mirrored by glass", "the picture of the dashboard, or of what else lies there, that "
                              "a window shows on its near side, over what is seen through it; "
                              "the mean over two degrees about the gaze."},
        {"arc minute", "a sixtieth of a degree: how large something looks. A coin of 2 cm is "
                       "14 arc minutes at 5 m."},
        {"glare probability, glare rating", "how much light disturbs, by formulas that were "
                                            "fitted to rooms; no verdict uses them."},
        {"just noticeable step", "the least difference in brightness that an average eye can "
                                 "tell (DICOM's scale)."}};
    page_more_begin(html, "The words on this page");
    text_add(html, "<dl class=\"facts made\">\n");
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS; i++)
        page_fact(html, WORDS[i][0], WORDS[i][1]);
    text_add(html, "</dl>\n");
    page_more_end(html);
}

/* ---- the page --------------------------------------------------------------------------- */

static bool end_page(Text *html, const ReviewPage *page, Arena *arena, Error *err)
{
    if (page->live && !review_live_add(html, page->review, page->live, arena, err))
        return false;
    page_end(html, "review",
             (const char *const[]){REVIEW_SCRIPT, LIVE_SCRIPT, LOOK_SCRIPT, NULL});
    return true;
}

static bool add_page(Text *html, const ReviewPage *page, Arena *arena, Error *err)
{
    if (!add_head(html, page, arena, err)) return false;
    add_diff(html, page, arena);
    if (!review_variants_add(html, page->review, page->pairs, arena, err)) return false;
    if (!add_sweeps(html, page, arena, err)) return false;
    text_add(html, "<p class=\"sub choice\"><label><input type=\"checkbox\" id=\"print-all\"/> "
             "print what follows, too</label></p>\n<div class=\"appendix\">\n");
    add_verdicts(html, page, arena);
    if (!add_cases(html, page, arena, err)) return false;
    review_gaze_add(html, page->review, arena);
    review_gaze_add_false_suns(html, page->review, arena);
    add_notes(html, page->review, arena);
    add_provenance(html, page, arena);
    add_glossary(html);
    text_add(html, "</div>\n");
    return end_page(html, page, arena, err);
}

/* The cards that the page itself leaves out. */
static bool add_beside(Text *html, const ReviewPage *page, Arena *arena, Error *err)
{
    const char *title = begin_page(html, page, 0, arena);
    page_element(html, "h1", arena_format(arena, "%s: all other cases", title));
    text_add(html, "<p class=\"sub\"><a href=\"index.html\">The answer, and the worst of "
             "them</a></p>\n");
    if (!add_sweeps(html, page, arena, err) || !add_cases(html, page, arena, err)) return false;
    add_glossary(html);
    return end_page(html, page, arena, err);
}

/* ---- one symbol alone ------------------------------------------------------------------- */

/* The review of one symbol alone. */
static Review part_of(const Review *whole, const char *symbol, Arena *arena)
{
    Review part = *whole;
    part.whole = whole;
    part.main_cards = part.case_count = part.sweep_count = part.gaze_count = 0;
    part.variant_count = part.sensitivity_count = part.mend_count = 0;
    part.cases = ARENA_NEW(arena, ReviewCase, whole->case_count);
    part.sweeps = ARENA_NEW(arena, ReviewSweep, whole->sweep_count);
    for (int i = 0; i < whole->case_count; i++)
        if (words_same(whole->cases[i].symbol, symbol))
            part.cases[part.case_count++] = whole->cases[i];
    for (int i = 0; i < whole->sweep_count; i++)
        if (words_same(whole->sweeps[i].symbol, symbol))
            part.sweeps[part.sweep_count++] = whole->sweeps[i];
    review_decide(&part);
    return part;
}

/* The part's own of a case or sweep of the whole; NULL: it is another symbol's. */
static const ReviewCase *case_of_part(const Review *part, const ReviewCase *of)
{
    const ReviewCase *like = review_case_like(part, of);
    return like && words_same(like->symbol, of->symbol) ? like : NULL;
}

static ReviewPage page_of_part(const ReviewPage *page, const Review *part, Arena *arena)
{
    ReviewPage     out = {.review = part, .is_dark = page->is_dark};
    ReviewPicture *pictures = ARENA_NEW(arena, ReviewPicture, page->picture_count);
    ReviewMap     *maps = ARENA_NEW(arena, ReviewMap, page->map_count);
    for (int i = 0; i < page->picture_count; i++) {
        const ReviewCase *of = case_of_part(part, page->pictures[i].of);
        if (!of) continue;
        ReviewPicture *p = &pictures[out.picture_count++];
        *p = page->pictures[i];
        p->of = of;
        p->id = NULL; /* nothing else of this page shows it */
        p->is_again = false;
    }
    for (int i = 0; i < page->map_count; i++) {
        const ReviewCase *of = case_of_part(part, &page->maps[i].of->worst);
        if (!of) continue;
        maps[out.map_count] = page->maps[i];
        maps[out.map_count++].of = review_sweep_of(part, of);
    }
    out.pictures = pictures;
    out.maps = maps;
    return out;
}

/* The map of the sweep whose worst case comes first. */
static bool add_worst_map(Text *html, const ReviewPage *page, Arena *arena, Error *err)
{
    CardList cards = list_cards(page->review, true, arena);
    if (cards.count == 0) return true;
    const ReviewSweep *s = review_sweep_of(page->review, cards.list[0]);
    page_element(html, "h2", arena_format(arena, "%s, seen by %s: %s",
                                          s->condition ? s->condition : "?",
                                          s->eye ? s->eye : "?", words_how_often(s, arena)));
    return add_sweep_figures(html, page, s, arena, err);
}

static bool add_summary(Text *html, const ReviewPage *page, Arena *arena, Error *err)
{
    if (!add_head(html, page, arena, err)) return false;
    text_add(html, "<div class=\"brief\">\n");
    if (!add_worst_map(html, page, arena, err)) return false;
    text_add(html, "</div>\n");
    page_element(html, "h2", "Every verdict");
    review_table_add_list(html, page->review, SUMMARY_ROWS, arena);
    text_add(html, "<p class=\"sub\"><a href=\"index.html\">All symbols</a></p>\n");
    page_end(html, "review", (const char *const[]){REVIEW_SCRIPT, NULL});
    return true;
}

/* ---- as a file -------------------------------------------------------------------------- */

typedef bool AddPage(Text *html, const ReviewPage *page, Arena *arena, Error *err);

static bool write_page(const ReviewPage *page, AddPage *add, Arena *words, const char *path,
                       Error *err)
{
    Arena own = arena_reserve(PAGE_BYTES);
    Text  html = {.arena = &own};
    bool  ok = add(&html, page, words, err) &&
              page_write((const Text *const[]){&html}, 1, path, err);
    arena_release(words);
    arena_release(&own);
    return ok;
}

bool review_page_write_summary(const ReviewPage *page, const char *symbol, const char *path,
                               Error *err)
{
    Arena      words = arena_reserve(WORDS_BYTES);
    Review     part = part_of(page->review, symbol, &words);
    ReviewPage alone = page_of_part(page, &part, &words);
    return write_page(&alone, add_summary, &words, path, err);
}

bool review_page_write(const ReviewPage *page, const char *path, Error *err)
{
    Arena words = arena_reserve(WORDS_BYTES);
    return write_page(page, page->review->is_beside ? add_beside : add_page, &words, path, err);
}
