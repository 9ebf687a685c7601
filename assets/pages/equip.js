/* SPDX-License-Identifier: Apache-2.0 */
/* The steps of `parhelion equip`'s page: displays, eyes, materials, the review, and the file
   that all of it goes into (parhelion schema equip). */
(function(){
var view=equipView,data=view.data,base=equipBase,state=base.state,pictures=base.pictures;
var $=base.$,make=base.make,say=base.say,round=base.round,list=base.list,vector=base.vector,
  inWorld=base.inWorld,fromWorld=base.fromWorld,freeName=base.freeName,
  numberField=base.numberField,choice=base.choice,card=base.card,shown=base.shown;
var frameOf=equipDisplay.frame;
var proposals=[],OWN='figures of its own',MODES=['display','draw','eye','hide'];

/* ---- eyes ---- */
function addEye(p){
  var eye={name:freeName(p.name||'driver eye'),position:p.position.slice(),why:p.why,
    looks:state.displays[0]||null,gaze:p.gaze||null,ahead:p.ahead||null};
  state.eyes.push(eye);
  state.chosen=eye;
  rebuild();
}
/* Until somebody chooses it himself: the axis nearest to where the first eye looks. */
function proposeForward(){
  var eye=state.eyes[0];
  if(state.forwardIsChosen||!eye)return;
  var d=targetOf(eye).sub(vector(eye.position)),isX=Math.abs(d.x)>Math.abs(d.z);
  $('forward').value=(isX?[Math.sign(d.x),0,0]:[0,0,d.z>0?1:-1]).join(',');
}
/* Between it and where an eye looks, seen from above; null: that one looks straight down. */
function offForward(eye){
  var d=targetOf(eye).sub(vector(eye.position)),a=ahead(),level=Math.hypot(d.x,d.z);
  if(level<0.001*d.length())return null;
  var cosine=(d.x*a[0]+d.z*a[2])/(level*Math.hypot(a[0],a[2]));
  return Math.acos(Math.max(-1,Math.min(1,cosine)))*180/Math.PI;
}
/* How far a display's picture is turned for an eye, to the left; null: not seen from the front. */
function turnFor(eye,d){
  var f=frameOf(d),way=f.centre.clone().sub(vector(eye.position)).normalize();
  var across=way.clone().cross(new THREE.Vector3(0,1,0));
  if(-way.dot(f.normal)<0.5||across.length()<0.05)return null;
  var above=across.normalize().clone().cross(way);
  return Math.atan2(-f.up.dot(across),f.up.dot(above))*180/Math.PI;
}
function ahead(){return $('forward').value.split(',').map(Number);}
/* While there is no display an eye looks ahead. */
function targetOf(eye){
  if(eye.looks)return frameOf(eye.looks).centre;
  return vector(eye.position).addScaledVector(vector(eye.gaze||eye.ahead||ahead()),0.7);
}
function lookThrough(eye){
  state.through=eye;
  view.look(vector(eye.position),targetOf(eye),60);
  tellLook();
}
function eyeCard(eye){
  var box=card(eye,eye.name,eye.why),fields=make('div',{'class':'fields'});
  ['X','Y','Z'].forEach(function(axis,a){
    fields.append(numberField(axis+', m',function(){return inWorld(eye.position)[a];},
      function(v){eye.position[a]=v-data.origin[a];eye.why='set by hand';},0.01));
  });
  fields.append(choice('Looks at',state.displays.map(function(d,i){return [String(i),d.name];})
    .concat([['','straight ahead']]),String(Math.max(-1,state.displays.indexOf(eye.looks)))
    .replace('-1',''),function(v){eye.looks=v===''?null:state.displays[+v];}));
  var through=make('button',{type:'button','class':'plain'},'Look through it');
  through.addEventListener('click',function(){lookThrough(eye);});
  box.append(fields,through);
  return box;
}

/* ---- materials ---- */
function usual(name){return data.usual.find(function(u){return u.name===name;});}
/* Until something else is chosen. */
function keptOf(id){
  var kept=state.kept[id];
  return kept&&(kept.as||OWN)===state.as[id]?kept:null;
}
function colourOf(id){
  var m=data.materials[id];
  var kept=keptOf(id);
  if(state.lit===id)return view.LIT;
  if(kept&&kept.base_color)return kept.base_color;
  if(state.as[id])return usual(state.as[id]).base_color;
  return m.missing&&$('mark').checked?view.MARK:null;
}
function css(rgb){
  return 'rgb('+rgb.map(function(v){
    return Math.round(255*Math.pow(Math.max(0,Math.min(1,v)),1/2.2));
  }).join(',')+')';
}
function wearers(id){
  var names=[...new Set(data.parts.filter(function(p){return p.material===id;})
    .map(function(p){return p.name;}))];
  return names.slice(0,2).join(', ')+(names.length>2?' and '+(names.length-2)+' more':'');
}
/* Where a row's material is. */
function light(id){
  state.lit=id;
  view.paint(colourOf);
}
function materialRow(id){
  var m=data.materials[id],row=make('div',{'class':'material'}),swatch=make('b');
  var name=make('span',{},m.name),select=make('select',{'aria-label':'What '+m.name+' is'});
  var source=make('span',{'class':'source'});
  name.append(make('small',{},wearers(id)));
  select.append(make('option',{value:''},m.missing?'not said':'as the model says'));
  data.usual.forEach(function(u){select.append(make('option',{value:u.name},u.name));});
  if(state.kept[id]&&!state.kept[id].as)select.append(make('option',{value:OWN},OWN));
  select.value=state.as[id]||'';
  function show(){
    var u=usual(state.as[id]);
    state.lit=null;
    swatch.style.background=css(colourOf(id)||m.color);
    source.textContent=u?u.source:'';
    source.hidden=!u;
  }
  select.addEventListener('change',function(){
    state.as[id]=select.value;
    show();
    view.paint(colourOf);
    changed();
  });
  show();
  ['mouseenter','focusin'].forEach(function(name){
    row.addEventListener(name,function(){light(id);});
  });
  ['mouseleave','focusout'].forEach(function(name){
    row.addEventListener(name,function(){light(null);});
  });
  row.dataset.material=id;
  row.append(swatch,name,select,source);
  return row;
}
function showMaterials(){
  var rows=[];
  data.materials.forEach(function(m,id){
    var isWorn=data.parts.some(function(p){return p.material===id;});
    if(m.missing||state.as[id]||($('every').checked&&isWorn&&!m.display))
      rows.push(materialRow(id));
  });
  $('materials').replaceChildren(...rows);
}

/* ---- what stands in the model ---- */
function eyeMark(eye){
  var group=new THREE.Group(),at=vector(eye.position);
  var ball=new THREE.Mesh(new THREE.SphereGeometry(0.025,20,14),
    new THREE.MeshBasicMaterial({color:state.chosen===eye?0xff8a1f:0x2f8fff}));
  ball.position.copy(at);
  var line=new THREE.Line(new THREE.BufferGeometry().setFromPoints([at,targetOf(eye)]),
    new THREE.LineBasicMaterial({color:0x2f8fff}));
  group.add(ball,line);
  group.at=at;
  return group;
}
function mark(){
  view.marks.remove(...view.marks.children);
  state.displays.forEach(function(d){
    view.marks.add(equipDisplay.mark(d));
    if(state.chosen===d&&!d.mesh)view.marks.add(equipDisplay.handleMarks(d));
  });
  state.eyes.forEach(function(e){view.marks.add(eyeMark(e));});
  view.draw();
}
view.onlook=function(camera){
  view.marks.children.forEach(function(g){
    if(g.at)g.visible=g.at.distanceTo(camera.position)>0.06;
  });
};

/* ---- the file ---- */
function eyeOf(e){
  var out={name:e.name,position_m:inWorld(e.position)};
  if(e.looks)out.looks_at=e.looks.name;
  else out.target_m=inWorld(targetOf(e));
  out.proposed_from=e.why;
  return out;
}
function numbersOf(text){
  return text.split(/[,;\s]+/).filter(Boolean).map(Number);
}
function equipOf(){
  var out={equip:1,model:data.model};
  if(state.displays.length)out.displays=state.displays.map(equipDisplay.saved);
  out.eyes=state.eyes.map(eyeOf);
  var ids=Object.keys(state.as).filter(function(id){return state.as[id];});
  if(ids.length)out.materials=ids.map(function(id){
    return keptOf(id)||{index:+id,name:data.materials[id].name,as:state.as[id]};
  });
  out.profile=$('profile').value;
  out.forward=ahead();
  if($('occupant').value&&state.eyes.length)
    out.occupant={eye:state.eyes[0].name,shirt:$('occupant').value};
  if($('has-place').checked)out.place={where:['lat','lon','alt'].map(function(id){
    return $(id).valueAsNumber;
  }),year:$('year').valueAsNumber,headings_deg:numbersOf($('headings').value)};
  return out;
}
function lacks(){
  var out=[],headings=numbersOf($('headings').value);
  state.displays.concat(state.eyes).forEach(function(x){if(x.bad)out.push(x.bad);});
  if(!state.displays.length)out.push('no display yet: click a face');
  if(!state.eyes.length)out.push('no eye yet');
  state.displays.forEach(function(d){out.push(...equipDisplay.lacks(d));});
  state.eyes.forEach(function(eye){
    var off=offForward(eye),turn=eye.looks&&!eye.looks.mesh?turnFor(eye,eye.looks):null;
    if(off>45)out.push('ahead is '+$('forward').selectedOptions[0].textContent+', "'+eye.name+
      '" looks '+off.toFixed(0)+'° off it: does the vehicle point there?');
    if(Math.abs(turn)>60)out.push('"'+eye.looks.name+'" stands '+(Math.abs(turn)>120?
      'upside down':'on its side')+' for "'+eye.name+'": turned by '+
      Math.abs(turn).toFixed(0)+'°');
  });
  if($('has-place').checked&&(!headings.length||headings.some(function(h){
    return !(h>=0&&h<=360);
  })||['lat','lon','alt','year'].some(function(id){return !$(id).validity.valid||
    !isFinite($(id).valueAsNumber);})))out.push('the place: a number is out of range');
  return out;
}
function save(){
  var text=JSON.stringify(equipOf(),null,1)+'\n';
  var link=make('a',{download:fileName(),
    href:URL.createObjectURL(new Blob([text],{type:'application/json'}))});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(function(){URL.revokeObjectURL(link.href);},10000);
}
function stem(){return data.model.replace(/\.[^.]*$/,'');}
function fileName(){return stem()+'.equip.json';}
function sceneName(){return stem()+'.equipped.gltf';}
function quoted(word){return /^[\w.,\/-]+$/.test(word)?word:"'"+word.replace(/'/g,"'\\''")+"'";}

/* A file that was saved is taken up again. */
function take(saved){
  state.displays=(saved.displays||[]).map(equipDisplay.taken);
  state.eyes=saved.eyes.map(function(e){
    var gaze=e.target_m?vector(e.target_m).sub(vector(e.position_m)).normalize():null;
    return {name:e.name,position:fromWorld(e.position_m),why:e.proposed_from||'as it was saved',
      gaze:gaze&&[gaze.x,gaze.y,gaze.z],
      looks:state.displays.find(function(d){return d.name===e.looks_at;})||null};
  });
  state.as={};
  state.kept={};
  (saved.materials||[]).forEach(function(m){
    if(!data.materials[m.index]||m.as&&!usual(m.as))return;
    state.as[m.index]=m.as||OWN;
    state.kept[m.index]=m;
  });
  $('occupant').value=saved.occupant?saved.occupant.shirt||'white':'';
  state.forwardIsChosen=!!saved.forward;
  $('profile').value=saved.profile||'iso-15008';
  var way=(saved.forward||[0,0,-1]).join(',');
  if(![...$('forward').options].some(function(o){return o.value===way;}))
    $('forward').append(make('option',{value:way},'('+way+')'));
  $('forward').value=way;
  $('has-place').checked=!!saved.place;
  if(saved.place){
    ['lat','lon','alt'].forEach(function(id,i){$(id).value=saved.place.where[i];});
    $('year').value=saved.place.year;
    $('headings').value=saved.place.headings_deg.join(', ');
  }
  showMaterials();
  view.paint(colourOf);
  rebuild();
}

/* ---- all of it ---- */
/* This page draws no light: the program shows what an eye sees. */
function tellLook(){
  var eye=state.eyes.includes(state.through)?state.through:state.eyes[0];
  $('look').hidden=!eye;
  $('look-say').textContent=eye?'This page draws the model without light. What "'+
    shown(eye.name)+'" sees under an even cloud, a denoised preview, not for figures:':'';
  if(eye)$('look').textContent=shown('parhelion render '+quoted(sceneName())+' --camera '+
    quoted(eye.name)+' --environment constant:3183 --preview -o look.exr '+
    '--png look.png');
}
function changed(){
  proposeForward();
  tellLook();
  var missing=lacks(),left=data.materials.filter(function(m,id){
    return m.missing&&!state.as[id];
  }).length;
  $('lacks').replaceChildren(...missing.map(function(t){return make('li',{},t);}));
  $('seat').textContent=$('occupant').value?'':'Nobody sits in the driver\'s seat: displays '+
    'reflect the empty seat back, no shirt.';
  $('place').hidden=!$('has-place').checked;
  $('step-displays').classList.toggle('done',state.displays.length>0);
  $('step-eyes').classList.toggle('done',state.eyes.length>0);
  $('step-materials').classList.toggle('done',!left);
  $('step-review').classList.add('done');
  $('missing').textContent=!left?'Every material has data.':left>1?left+
    ' materials say nothing of what light does there: say what they are.':
    '1 material says nothing of what light does there: say what it is.';
  mark();
}
function rebuild(){
  $('displays').replaceChildren(...state.displays.map(equipDisplay.card));
  $('eyes').replaceChildren(...state.eyes.map(eyeCard));
  changed();
}
function setMode(mode){
  state.mode=mode;
  MODES.forEach(function(m){
    $('mode-'+m).setAttribute('aria-pressed',String(m===mode));
  });
  say({eye:'Click a headrest, a cushion or a place before which the eye is.',
    draw:'Press on a face and drag: the rectangle becomes a display.',
    hide:'Click what is in the way: it is hidden here, the scene keeps it.',
    display:'Click a face that is a display.'}[mode]);
}
function hide(hit){
  var part=view.partOf[hit.triangle];
  view.hide(part);
  $('show-all').hidden=false;
  say('"'+data.parts[part].name+'" is hidden here; the scene keeps it.');
}
view.onclick=function(hit){
  if(!hit){say('There is nothing under that place.',true);return;}
  if(state.mode==='hide'){hide(hit);return;}
  if(state.mode!=='eye'){equipDisplay.click(hit);return;}
  var p=equipEye.before(hit),eye=state.eyes.includes(state.chosen)?state.chosen:state.eyes[0];
  if(eye){eye.position=p.position;eye.why=p.why;state.chosen=eye;rebuild();}
  else addEye(p);
  say('"'+state.chosen.name+'" is '+state.chosen.why+'.');
};
function offerProposals(){
  proposals=equipEye.proposals();
  proposals.forEach(function(p){
    var button=make('button',{type:'button',title:p.why},p.label);
    button.addEventListener('click',function(){addEye(p);lookThrough(state.chosen);});
    $('proposals').append(' ',button);
  });
}
function fill(){
  $('title').textContent='Equip '+shown(data.model);
  var long=Math.max(...data.high.map(function(h,a){return h-data.low[a];}));
  if(long>100||long<0.3)$('units').textContent='The model is '+long.toPrecision(3)+
    ' m long. glTF counts in metres: was it exported in another unit?';
  $('about').textContent=data.triangles.toLocaleString('en')+' triangles, '+data.parts.length+
    ' parts, '+data.high.map(function(h,a){return (h-data.low[a]).toFixed(2);}).join(' × ')+
    ' m';
  data.profiles.forEach(function(p){$('profile').append(make('option',{value:p},p));});
  $('profile').value='iso-15008';
  var own=data.materials.filter(function(m){return m.display;})
    .map(function(m){return m.name;});
  $('own-displays').textContent=own.length?'Displays already: '+
    shown(own.join(', '))+'.':'';
  $('command').textContent=shown(data.command+' --with '+quoted(fileName())+
    ' -o '+quoted(sceneName()));
  data.contents.forEach(function(c){
    pictures[c.name]=c;
    if(!c.picture)return;
    c.texture=new THREE.TextureLoader().load(c.picture,view.draw);
    c.texture.encoding=THREE.sRGBEncoding;
    c.texture.minFilter=THREE.LinearFilter;
  });
}
function connect(){
  MODES.forEach(function(m){
    $('mode-'+m).addEventListener('click',function(){setMode(m);});
  });
  $('forward').addEventListener('input',function(){state.forwardIsChosen=true;});
  $('show-all').addEventListener('click',function(){
    view.hide(null);
    $('show-all').hidden=true;
  });
  $('x-ray').addEventListener('click',function(){
    view.clear(!view.isClear);
    $('x-ray').setAttribute('aria-pressed',String(view.isClear));
  });
  ['profile','has-place','lat','lon','alt','year','headings','forward','occupant'].forEach(function(id){
    $(id).addEventListener('input',changed);
  });
  $('mark').addEventListener('input',function(){view.paint(colourOf);showMaterials();});
  $('every').addEventListener('input',showMaterials);
  $('save').addEventListener('click',save);
  $('open').addEventListener('change',async function(e){
    try{
      take(JSON.parse(await e.target.files[0].text()));
      say('Taken up again.');
    }catch(fault){say('That file was not saved by this page: '+fault.message,true);}
  });
  $('view-all').addEventListener('click',function(){view.all(0.6,0.35);});
  $('view-top').addEventListener('click',function(){view.all(0,1.55);});
  $('view-eye').addEventListener('click',function(){
    var eye=state.eyes.includes(state.chosen)?state.chosen:state.eyes[0];
    if(eye)lookThrough(eye);
    else say('There is no eye yet.',true);
  });
  $('view-front').addEventListener('click',function(){
    var a=ahead();
    view.all(Math.atan2(-a[0],-a[2]),0.1);
  });
}
async function start(){
  base.changed=changed;
  base.rebuild=rebuild;
  try{await view.start();}
  catch(fault){
    say('The model cannot be shown here: '+fault.message+'. A browser with WebGL is required.',
      true);
    return;
  }
  fill();
  connect();
  offerProposals();
  view.paint(colourOf);
  view.all(0.6,0.35);
  if(proposals.length){addEye(proposals[0]);lookThrough(state.eyes[0]);}
  showMaterials();
  rebuild();
  setMode('display');
  window.parhelionEquip={ready:true,project:view.project,equip:equipOf,lacks:lacks,
    handles:function(){
      return state.displays.includes(state.chosen)?equipDisplay.handlesOf(state.chosen)
        .map(function(h){return {kind:h.kind,x:h.x,y:h.y,at:list(h.at)};}):[];
    }};
}
start();
})();
