/* SPDX-License-Identifier: Apache-2.0 */
/* The verdict that a page's script gives for a moved sun or another brightness is the judge's,
 * over random cases. It takes node; without one it is skipped. */
#include "fixture.h"

#include "page/template.h"
#include "review/judge.h"

#define CASES 4000

static const char *page_script(const char *name)
{
    for (int i = 0; i < page_file_count; i++)
        if (!strcmp(page_file_table[i].name, name)) return page_file_table[i].text;
    fail_msg("no %s", name);
    return NULL;
}

/* Of its own: the same numbers everywhere. */
static double random_between(double low, double high)
{
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return low * pow(high / low, state / 4294967296.0);
}

static void add_number(Text *to, double value)
{
    if (isinf(value)) text_add(to, value > 0 ? "Infinity," : "-Infinity,");
    else text_format(to, "%.17g,", value);
}

/* A display in some light, judged by one limit with nothing in doubt. */
static void add_case(Text *to, int i, Arena scratch)
{
    static const LimitKind KINDS[] = {LIMIT_CONTRAST_RATIO, LIMIT_LUMINANCE_CONTRAST,
                                      LIMIT_MODULATION, LIMIT_VISUAL_SECURITY};
    LimitKind    kind = KINDS[i % 4];
    double       foreground = i % 5 ? random_between(0.01, 1000) : 0, level = 1;
    double       background = i % 7 ? random_between(0.01, 1000) : 0;
    double       reflected = i % 11 ? random_between(1e-3, 1e5) : 0;
    ProfileLimit limit = {.name = "one", .kind = kind, .ambients = {true, true, true, true},
                          .value = contrast_from_ratio(kind, random_between(1.01, 50))};
    Profile      profile = {.limits = &limit, .limit_count = 1};
    if (i % 2) level = random_between(0.05, 4);
    ReviewCase c = {.luminance_cd_m2 = {foreground * level, background * level, reflected,
                                        reflected, 0, 0},
                    .height_arcmin = 20, .stroke_ratio = 0.15, .visible_share = 1,
                    .must_not_be_read = kind == LIMIT_VISUAL_SECURITY};
    judge_contrasts(&c, (MeanInterval){reflected, reflected});
    judge_case(&c, &profile, &scratch);
    text_add(to, "[");
    add_number(to, foreground);
    add_number(to, background);
    add_number(to, level);
    add_number(to, reflected);
    text_format(to, "[%.17g,'%s'],", limit.value, limit_kinds[kind].name);
    add_number(to, c.margin);
    text_format(to, "%d],\n", (int)c.verdict);
}

/* The first of the script's two parts is all that judges; it takes a page that has numbers. */
static const char RUN[] =
    "const fs=require('fs'),src=fs.readFileSync(process.argv[2],'utf8'),"
    "cases=require(process.argv[3]),end='\\n})();';\n"
    "const tools=new Function('window','document',"
    "src.slice(0,src.indexOf(end)+end.length)+';return liveTools')(\n"
    "  {DecompressionStream:1,Blob:1},{getElementById:()=>({textContent:'{}'})});\n"
    "let wrong=0;\n"
    "for(const [foreground,background,level,reflected,limit,margin,verdict] of cases){\n"
    "  const ratio=tools.contrast(foreground,background,level,reflected);\n"
    "  const at=tools.marginOf(limit,ratio),is=tools.verdictAt(tools.FAIL,-1,at);\n"
    "  const same=at===margin||Math.abs(at-margin)<=1e-9*(1+Math.abs(margin));\n"
    "  if(same&&is===verdict)continue;\n"
    "  wrong++;console.log(foreground,background,level,reflected,limit,margin,verdict,at,is);\n"
    "}\n"
    "process.exit(wrong?1:0);\n";

ARENA_TEST(a_moved_sun_is_judged_as_the_review_judges)
{
    Text cases = {.arena = &arena};
    if (system("node --version >/dev/null 2>&1") != 0) {
        print_message("no node here: the page's verdicts are not compared\n");
        skip();
    }
    text_add(&cases, "module.exports=[\n");
    ENDS_BY(arena_release) Arena scratch = arena_reserve(1 << 20);
    for (int i = 0; i < CASES; i++) add_case(&cases, i, scratch);
    text_add(&cases, "];\n");
    write_text(in_folder("live.js"), page_script("review_live.js"));
    write_text(in_folder("cases.js"), cases.data);
    write_text(in_folder("run.js"), RUN);
    const char *folder = test_folder();
    assert_int_equal(system(arena_format(&arena, "node %s/run.js %s/live.js %s/cases.js",
                                         folder, folder, folder)), 0);
}

TEST_PROGRAM(make_folder, clear_folder)
