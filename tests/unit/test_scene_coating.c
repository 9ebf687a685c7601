/* SPDX-License-Identifier: Apache-2.0 */
/* Coatings and measured metals of a scene: what is read, and what is said of wrong ones. */
#include "check.h"
#include "base/count.h"
#include "gltf_maker.h"

#define COATING_PLACE "/materials/0/extensions/PARHELION_coating"
#define COATED(body) \
    "'extensionsUsed':['PARHELION_coating'],'materials':[{'pbrMetallicRoughness':" \
    "{'metallicFactor':0},'extensions':{'PARHELION_coating':{" body "}}}]"

static const FaultCase FAULTS[] = {
    {COATED("'stack':'mgf'"), COATING_PLACE "/stack",
     "no coating is named \"mgf\" — did you mean mgf2?"},
    {COATED("'outside':1"), COATING_PLACE, "holds neither \"layers\" nor \"stack\""},
    {COATED("'stack':'mgf2','layers':[]"), COATING_PLACE "/stack", "stands beside \"layers\""},
    {COATED("'stack':'mgf2','outside':0.5"), COATING_PLACE "/outside",
     "is 0.5, a number from 1 to 10 is required"},
    {COATED("'stack':'mgf2','faces':'inner'"), COATING_PLACE "/faces",
     "is \"inner\", one of both|front|back is required"},
    {COATED("'stack':'mgf2','ouside':1"), COATING_PLACE "/ouside",
     "nearest known one is 'outside'"},
    {COATED("'layers':{}"), COATING_PLACE "/layers", "is an object, an array is required"},
    {COATED("'layers':[{'n':1.38}]"), COATING_PLACE "/layers/0", "\"thickness_nm\" is missing"},
    {COATED("'layers':[{'thickness_nm':100}]"), COATING_PLACE "/layers/0", "\"n\" is missing"},
    {COATED("'layers':[{'n':-1.38,'thickness_nm':100}]"), COATING_PLACE "/layers/0/n",
     "is -1.38, a number from 0 to 100"},
    {COATED("'layers':[{'n':[1.38],'thickness_nm':100}]"), COATING_PLACE "/layers/0/n",
     "is neither a number nor the name of a file"},
    {COATED("'layers':[{'n':1.38,'k':-1,'thickness_nm':100}]"), COATING_PLACE "/layers/0/k",
     "is -1, a number from 0 to 100"},
    {COATED("'layers':[{'n':0,'thickness_nm':100}]"), COATING_PLACE "/layers/0/n",
     "is 0 and so is k"},
    {COATED("'layers':[{'n':1.38,'thickness_nm':-1}]"), COATING_PLACE "/layers/0/thickness_nm",
     "is -1, a number from 0 to 1000000"},
    {COATED("'layers':[{'n':'none.csv','thickness_nm':10}]"), COATING_PLACE "/layers/0/n",
     "No such file"},
    {COATED("'layers':[{'n':'http://a/b.csv','thickness_nm':10}]"), COATING_PLACE "/layers/0/n",
     "the URI's scheme is"},
    {"'extensionsUsed':['PARHELION_coating'],'materials':[{'extensions':{'PARHELION_coating':"
     "{'stack':'mgf2'}}}]",
     COATING_PLACE, "lies on a metal (metallicFactor 1) whose n and k are not known"},
    {"'extensionsUsed':['PARHELION_coating','KHR_materials_clearcoat'],'materials':[{"
     "'pbrMetallicRoughness':{'metallicFactor':0},'extensions':{'KHR_materials_clearcoat':"
     "{'clearcoatFactor':1},'PARHELION_coating':{'stack':'mgf2'}}}]",
     COATING_PLACE, "stands beside KHR_materials_clearcoat"},
    {"'extensionsUsed':['PARHELION_coating','KHR_materials_ior'],'materials':[{"
     "'pbrMetallicRoughness':{'metallicFactor':0},'extensions':{'KHR_materials_ior':"
     "{'ior':0},'PARHELION_coating':{'stack':'mgf2'}}}]",
     COATING_PLACE, "lies on a body of infinite index (ior 0)"},
    {"'extensionsUsed':['PARHELION_coating','PARHELION_glazing'],'materials':[{"
     "'pbrMetallicRoughness':{'metallicFactor':0},'extensions':{'PARHELION_glazing':"
     "{'layers':[{'thickness_m':0.004,'ior':1.52}]},'PARHELION_coating':{'stack':'mgf2'}}}]",
     COATING_PLACE, "stands beside PARHELION_glazing"},
    {"'extensionsUsed':['PARHELION_spectrum'],'materials':[{'extensions':{'PARHELION_spectrum':"
     "{'conductor':'none.csv'}}}]",
     "/materials/0/extensions/PARHELION_spectrum/conductor", "No such file"},
};

TEST_WITH(every_fault_is_named_with_its_place, maker_reset, NULL) {
    maker_expect_faults(FAULTS, COUNT_OF(FAULTS), NULL, 0);
}

static const Material *coated(const char *body) {
    return &maker_load(NULL, 0, maker_format(COATED("%s"), body))->materials[0];
}

TEST_WITH(layers_are_read_from_outside_inwards, maker_reset, NULL) {
    const LayerStack *stack =
        coated("'layers':[{'n':1.38,'thickness_nm':100},{'n':2,'k':0.5,'thickness_nm':20}],"
               "'outside':1.33,'faces':'back'")
            ->coating;
    assert_int_equal(stack->count, 2);
    assert_int_equal(stack->faces, COATED_BACK);
    assert_near(stack->outside, 1.33, 0);
    assert_near(stack->layers[0].thickness_nm, 100, 0);
    assert_near(stack->layers[0].index.n.value[200], 1.38, 1e-6);
    assert_near(stack->layers[0].index.k.value[200], 0, 0);
    assert_near(stack->layers[1].index.k.value[0], 0.5, 0);
    assert_int_equal(coated("'layers':[]")->coating->count, 0);
}

TEST_WITH(the_programs_own_stacks_are_whole, maker_reset, NULL) {
    const LayerStack *silver = coated("'stack':'ir_windscreen'")->coating;
    assert_int_equal(silver->count, 3);
    assert_int_equal(silver->faces, COATED_BOTH);
    assert_near(silver->outside, 1, 0);
    assert_close(silver->layers[1].index.k.value[550 - CURVE_FIRST_NM], 3.6, 0.01);
    assert_close(silver->layers[0].index.n.value[550 - CURVE_FIRST_NM], 2.436, 1e-3);
    assert_int_equal(coated("'stack':'bare'")->coating->count, 0);
    assert_int_equal(coated("'stack':'mgf2'")->coating->count, 1);
    assert_int_equal(coated("'stack':'broadband_ar'")->coating->count, 4);
}

TEST_PROGRAM(maker_start, maker_end)
