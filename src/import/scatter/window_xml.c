/* SPDX-License-Identifier: Apache-2.0 */
/* WINDOW's and Radiance's BSDF as XML: a matrix over Klems patches, or a tensor tree.
 *
 * Angles count counter-clockwise as seen from the side that reflects. The number of an incident
 * patch is that of the patch which the light would be mirrored INTO: a mirror is a diagonal
 * matrix. */
#include "import/scatter/window_xml.h"

#include <libxml/parser.h>
#include <libxml/tree.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "text/xml_tags.h"
#include "text/xml_text.h"

#define BASES_MAX 16

typedef struct Document {
    const char *file;
    Arena      *arena;
    xmlDoc     *tree;
    WindowBasis basis[BASES_MAX];
    int         bases;
} Document;

/* ---- elements ---------------------------------------------------------------------------- */

static bool is_named(const xmlNode *node, const char *name)
{
    return node->type == XML_ELEMENT_NODE && !strcmp((const char *)node->name, name);
}

static xmlNode *next_named(xmlNode *node, const char *name)
{
    while (node && !is_named(node, name)) node = node->next;
    return node;
}

static xmlNode *child(const xmlNode *node, const char *name)
{
    return node ? next_named(node->children, name) : NULL;
}

/* The text of a child, blanks around it removed; "" when there is none. */
static const char *text_of(const Document *in, const xmlNode *node, const char *name)
{
    xmlNode *element = child(node, name);
    xmlChar *content = element ? xmlNodeGetContent(element) : NULL;
    if (!content) return "";
    const char *begin = (const char *)content + strspn((const char *)content, " \t\r\n");
    size_t      length = strlen(begin);
    while (length && strchr(" \t\r\n", begin[length - 1])) length--;
    const char *text = arena_string(in->arena, begin, length);
    xmlFree(content);
    return text;
}

static bool fail_at(const Document *in, const xmlNode *node, Error *err, const char *what,
                    const char *wanted)
{
    char place[32] = "";
    if (node) snprintf(place, sizeof place, "line %ld", xmlGetLineNo(node));
    return error_at(err, ERROR_INPUT, in->file, place, "%s, required: %s", what, wanted);
}

/* ---- opening ----------------------------------------------------------------------------- */

/* Without a document type nothing can be fetched, and nothing expands. */
static bool check_type(const char *file, const char *text, Error *err)
{
    if (strstr(text, "<!DOCTYPE") || strstr(text, "<!ENTITY"))
        return error_at(err, ERROR_INPUT, file, "", "has a document type (<!DOCTYPE), which is "
                        "not taken");
    return true;
}

static bool parse(Document *in, Error *err)
{
    FileBytes   bytes;
    const char *text;
    if (!file_read(in->file, IMPORT_FILE_BYTES_MAX, in->arena, &bytes, err) ||
        !xml_text_read(in->file, &bytes, in->arena, &text, err) ||
        !check_type(in->file, text, err) || !xml_tags_check(text, in->file, err))
        return false;
    int options = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE |
                  XML_PARSE_NOCDATA | XML_PARSE_IGNORE_ENC;
    xmlParserCtxt *context = xmlNewParserCtxt();
    if (!context) return error_at(err, ERROR_MEMORY, in->file, "", "out of memory");
    in->tree = xmlCtxtReadMemory(context, text, (int)strlen(text), in->file, "UTF-8", options);
    const xmlError *problem = xmlCtxtGetLastError(context);
    if (!in->tree) {
        const char *why = problem && problem->message ? problem->message : "is not XML";
        char        place[32] = "";
        if (problem && problem->line) snprintf(place, sizeof place, "line %d", problem->line);
        error_at(err, ERROR_INPUT, in->file, place, "is no sound XML: %.*s",
                 (int)strcspn(why, "\r\n"), why);
    }
    xmlFreeParserCtxt(context);
    return in->tree != NULL;
}

/* ---- angle bases ------------------------------------------------------------------------- */

/* Klems' bases as WINDOW has them built in (they need not stand in the file). */
static void add_known_bases(Document *in)
{
    static const WindowBasis known[] = {
        {"LBNL/Klems Full", 9, {5, 15, 25, 35, 45, 55, 65, 75, 90},
         {1, 8, 16, 20, 24, 24, 24, 16, 12}, 145},
        {"LBNL/Klems Half", 7, {6.5, 19.5, 32.5, 46.5, 61.5, 76.5, 90},
         {1, 8, 12, 16, 20, 12, 4}, 73},
        {"LBNL/Klems Quarter", 5, {9, 27, 46, 66, 90}, {1, 8, 12, 12, 8}, 41},
    };
    for (int i = 0; i < 3; i++) in->basis[in->bases++] = known[i];
}

static bool read_latitude(const Document *in, const xmlNode *block, WindowBasis *basis,
                          Error *err)
{
    const xmlNode *bounds = child(block, "ThetaBounds");
    double         low, high, pieces;
    if (!scan_to_number(text_of(in, bounds, "LowerTheta"), &low) ||
        !scan_to_number(text_of(in, bounds, "UpperTheta"), &high) ||
        !scan_to_number(text_of(in, block, "nPhis"), &pieces))
        return fail_at(in, block, err, "an AngleBasisBlock lacks a number",
                       "LowerTheta, UpperTheta and nPhis");
    double begin = basis->latitudes ? basis->upper_deg[basis->latitudes - 1] : 0;
    if (!(low > begin - 1e-3 && low < begin + 1e-3) || !(high > low && high <= 90 + 1e-3))
        return fail_at(in, block, err, "the theta bounds do not follow each other",
                       "bounds that rise from 0 to 90");
    if (!(pieces >= 1 && pieces <= 4096 && pieces == (int)pieces))
        return fail_at(in, block, err, "nPhis is out of range", "1 to 4096");
    if (basis->latitudes == WINDOW_LATITUDES_MAX)
        return fail_at(in, block, err, "there are too many latitudes", "at most 64");
    basis->upper_deg[basis->latitudes] = high > 90 ? 90 : high;
    basis->pieces[basis->latitudes++] = (int)pieces;
    basis->patches += (int)pieces;
    return true;
}

/* Bases of the file's own; one with a known name is taken as known. */
static bool read_bases(Document *in, const xmlNode *definition, Error *err)
{
    for (xmlNode *node = child(definition, "AngleBasis"); node;
         node = next_named(node->next, "AngleBasis")) {
        WindowBasis basis = {.name = text_of(in, node, "AngleBasisName")};
        bool        is_known = false;
        for (int i = 0; i < in->bases; i++)
            is_known |= !strcasecmp(in->basis[i].name, basis.name);
        if (is_known) continue;
        if (in->bases == BASES_MAX)
            return fail_at(in, node, err, "there are too many angle bases", "at most 13");
        for (xmlNode *block = child(node, "AngleBasisBlock"); block;
             block = next_named(block->next, "AngleBasisBlock"))
            if (!read_latitude(in, block, &basis, err)) return false;
        in->basis[in->bases++] = basis;
    }
    return true;
}

static bool find_basis(const Document *in, const xmlNode *block, const char *element,
                       WindowBasis *out, Error *err)
{
    const char *name = text_of(in, block, element);
    for (int i = 0; i < in->bases; i++)
        if (!strcasecmp(in->basis[i].name, name) && in->basis[i].patches) {
            *out = in->basis[i];
            return true;
        }
    const char *what = arena_format(in->arena, "%s is '%.60s', which is not defined", element,
                                    name);
    return fail_at(in, block, err, what, "the name of an angle basis");
}

/* ---- the data ---------------------------------------------------------------------------- */

typedef struct Found {
    xmlNode *front, *back; /* blocks of photopic reflection */
    bool     has_transmission, has_other; /* other: wavelengths that are not photopic */
} Found;

static void find_blocks(const Document *in, const xmlNode *layer, Found *found)
{
    for (xmlNode *data = child(layer, "WavelengthData"); data;
         data = next_named(data->next, "WavelengthData")) {
        bool is_photopic = !strcasecmp(text_of(in, data, "Wavelength"), "Visible");
        for (xmlNode *block = child(data, "WavelengthDataBlock"); block;
             block = next_named(block->next, "WavelengthDataBlock")) {
            const char *side = text_of(in, block, "WavelengthDataDirection");
            bool is_front = !strcasecmp(side, "Reflection Front");
            bool is_back = !strcasecmp(side, "Reflection Back");
            found->has_transmission |= !strncasecmp(side, "Transmission", 12);
            found->has_other |= !is_photopic && (is_front || is_back);
            if (is_photopic && is_front) found->front = block;
            if (is_photopic && is_back) found->back = block;
        }
    }
}

static xmlNode *choose_block(const Document *in, const xmlNode *layer, ImportSet *set,
                             Error *err)
{
    Found found = {NULL, NULL, false, false};
    find_blocks(in, layer, &found);
    const char *name = path_name(in->file);
    if (!found.front && !found.back) {
        fail_at(in, layer, err, found.has_other          ? "there is no reflection at Visible"
                                : found.has_transmission ? "there is transmission only"
                                                         : "there is no scattering data",
                "a WavelengthDataBlock of Reflection Front at the wavelength Visible: a "
                "display panel is opaque");
        return NULL;
    }
    if (!found.front)
        import_note(set, "%s: has no Reflection Front; Reflection Back is taken", name);
    else if (found.back)
        import_note(set, "%s: Reflection Front is taken, Reflection Back left out", name);
    if (found.has_other)
        import_note(set, "%s: reflection at other wavelengths than Visible is left out", name);
    return found.front ? found.front : found.back;
}

static bool read_structure(const Document *in, const xmlNode *layer, WindowXml *out, Error *err)
{
    static const char *const names[] = {"Columns", "Rows", "TensorTree3", "TensorTree4",
                                        NULL};
    const xmlNode *definition = child(layer, "DataDefinition");
    const char    *name = text_of(in, definition, "IncidentDataStructure");
    int            found = import_word_find(names, name);
    if (found >= 0) {
        out->structure = (WindowStructure)found;
        return true;
    }
    return fail_at(in, definition ? definition : layer, err,
                   arena_format(in->arena, "IncidentDataStructure is '%.40s'", name),
                   "Columns, Rows, TensorTree3 or TensorTree4");
}

static bool take_data(Document *in, const xmlNode *block, WindowXml *out, Error *err)
{
    const xmlNode *data = child(block, "ScatteringData");
    if (!data) return fail_at(in, block, err, "the block has no ScatteringData", "numbers");
    const char *text = text_of(in, block, "ScatteringData");
    out->data = (WordScan){.file = in->file, .next = text, .end = text + strlen(text),
                       .line = (int)xmlGetLineNo(data), .commas = true, .arena = in->arena};
    if (out->structure == WINDOW_COLUMNS || out->structure == WINDOW_ROWS)
        return find_basis(in, block, "ColumnAngleBasis", &out->incident, err) &&
               find_basis(in, block, "RowAngleBasis", &out->leaving, err);
    const char *basis = text_of(in, block, "AngleBasis");
    if (strcasecmp(basis, "LBNL/Shirley-Chiu"))
        return fail_at(in, block, err, arena_format(in->arena, "AngleBasis is '%.60s'", basis),
                       "LBNL/Shirley-Chiu for a tensor tree");
    return true;
}

static bool read_document(Document *in, ImportSet *set, WindowXml *out, Error *err)
{
    xmlNode *root = xmlDocGetRootElement(in->tree);
    xmlNode *layer = root ? child(child(root, "Optical"), "Layer") : NULL;
    if (!root || !is_named(root, "WindowElement") || !layer)
        return fail_at(in, root, err, "the document is not of this kind",
                       "WindowElement / Optical / Layer");
    if (next_named(layer->next, "Layer"))
        import_note(set, "%s: the first of several layers is taken", path_name(in->file));
    const char *name = text_of(in, child(layer, "Material"), "Name");
    out->panel = *name ? name : NULL;
    xmlNode *block = choose_block(in, layer, set, err);
    if (!block) return false;
    add_known_bases(in);
    return read_structure(in, layer, out, err) &&
           read_bases(in, child(layer, "DataDefinition"), err) &&
           take_data(in, block, out, err);
}

bool window_xml_read(const char *file, ImportSet *set, WindowXml *out, Error *err)
{
    Document in = {.file = file, .arena = set->arena};
    *out = (WindowXml){.file = file};
    if (!parse(&in, err)) return false;
    bool ok = read_document(&in, set, out, err);
    xmlFreeDoc(in.tree);
    return ok;
}
